#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "certificate/plant_matrices.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/law_gains.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Something that a file states of a plant and that the plant's own maps refute at a point.
struct Contradiction {
  /// That states it: "lipschitz_constant", "vertices", "jacobian_vertices",
  /// "jump_map/lipschitz_constant", "A", "A_d" or "injection_lipschitz".
  std::string key;
  std::string expected;  ///< what the plant's maps ask of it, with the point
  std::string found;
};

// All look at pairs of points, the same in every run, at distances from 1e-7 to 1e4 times the size
// of `centre` (n entries) or 1: near it, and far away, since what is stated is stated of all
// states. What they find is certain; what they do not find may be wrong all the same.

/// Compares `lipschitz_constant` and `vertices` of a Lipschitz plant with its ψ:
///   |ψ(a) − ψ(b)| <= ℓ |a − b|,  G (ψ(S x) − ψ(S x̂)) in the convex hull of all Ψ_i (x − x̂),
/// or `jacobian_vertices` with the flow, as PolytopicDescription has it. Nothing for a plant of
/// another kind.
std::optional<Contradiction> refute_lipschitz_claims(const Plant& plant,
                                                     const Eigen::VectorXd& centre);

/// Compares `lipschitz_constant` of a jump map with it: |g(a) − g(b)| <= k |a − b|. Nothing where
/// none is stated.
std::optional<Contradiction> refute_jump_constant(const Plant& plant,
                                                  const Eigen::VectorXd& centre);

/// Compares stated maps of the error with those of the plant and of an observer that takes states
/// from outputs:
///   f(x, u) − f(x̂ with injected outputs of x, u) = A (x − x̂),  g(x, u) − g(x̂, u) = A_d (x − x̂).
/// @pre the plant does not switch
std::optional<Contradiction> refute_error_maps(const Plant& plant, const StatedErrorMaps& stated,
                                               const std::vector<OutputInjection>& injections,
                                               const Eigen::VectorXd& centre);

/// Compares what an injected output y that picks a state makes of the flow with what is stated:
///   |f_i(x with y) − f_i(x with y')| <= constants(i) |y − y'|.
/// @param constants  n
std::optional<Contradiction> refute_injection_constants(const Plant& plant,
                                                        const OutputInjection& injection,
                                                        const Eigen::VectorXd& constants,
                                                        const Eigen::VectorXd& centre);

/// The output injections under which nothing refutes the stated maps; none where there are no such.
std::optional<std::vector<OutputInjection>> injections_that_explain(const Plant& plant,
                                                                    const StatedErrorMaps& stated,
                                                                    const Eigen::VectorXd& centre);

/// In the form of the key gains/output_injection: "{x1: membrane}".
std::string in_words(const Plant& plant, const std::vector<OutputInjection>& injections);

/// @param plant_section  `plant`, of the file that states ℓ and the vertices
/// @param stated_section  the section that states the maps: `design`, or `certificate`
/// @throws ConfigError for the first statement that is refuted, whatever outputs are injected.
void require_no_contradiction(const Plant& plant, const StatedErrorMaps& stated,
                              ConfigSection& plant_section, ConfigSection& stated_section);

}  // namespace sampled_data_observers
