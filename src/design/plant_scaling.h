#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "design/design_method.h"

namespace sampled_data_observers {

/// Units in which a design is computed, so that it does not depend on those of the plant file:
///   x = diag(state) x̃, y = diag(output) ỹ, t = time t̃, w = disturbance w̃, ψ = nonlinearity ψ̃,
///   y_p = performance ỹ_p.
/// The last three are one factor each, since the papers' norms of them are Euclidean.
struct PlantScaling {
  Eigen::VectorXd state;
  Eigen::VectorXd output;             ///< of C
  Eigen::VectorXd continuous_output;  ///< of C_c
  Eigen::VectorXd jump_output;        ///< of C_d
  double time = 1.0;                  ///< [s]
  double disturbance = 1.0;
  double nonlinearity = 1.0;
  double performance = 1.0;
  std::vector<SampledOutputs> sampled;  ///< whose entries of `output` are whose
  Eigen::Index nonlinearities = 0;      ///< s, entries of ψ that a constant bounds
};

/// Those in which nothing changes.
PlantScaling units_of_file(const CertificateSubject& subject);

/// Euclidean norms that must stay what they are but for a factor, so that all entries have one.
struct KeptNorms {
  bool of_state = false;
  bool of_outputs = false;
  bool of_each_sensor = false;  ///< of the outputs of each by itself
};

/// The units in which each state moves the outputs by about 1 within time_scale(), and each row of
/// C has norm 1. The plant in these units, and so a design, is the same whatever units it was
/// written in. Where a theorem itself depends on units, only those on which it does not are
/// changed.
PlantScaling scaling_of(const Theorem& theorem, const CertificateSubject& subject,
                        const KeptNorms& kept);

/// The units of the plant file, seen from these.
PlantScaling inverse_of(const PlantScaling& scaling);

/// Whether a parameter of methods or theorems is a rate in 1/s.
bool is_rate(const std::string& name);

/// Whether gamma is for the Euclidean norm of the state, by P > I.
bool has_norm_of_state(const Theorem& theorem);

/// Whether it speaks of the Euclidean norm of the noise of each sensor.
bool has_norm_of_noise(const Theorem& theorem);

/// Whether conditions in other units are other ones: by P > I, or by a basis of the state that is
/// computed in floating point.
bool has_conditions_for_units(const Theorem& theorem);

/// The nearest units by which a change is exact in floating point.
PlantScaling rounded_to_powers_of_two(PlantScaling scaling);

CertificateSubject scaled(const CertificateSubject& subject, const PlantScaling& scaling);

/// The plant in such units of states and outputs, but with times in seconds.
CertificateSubject balanced(const CertificateSubject& subject);

/// The parameters of a method in these units, but for `gain_bound`.
Parameters scaled(const Theorem& theorem, const Parameters& parameters,
                  const PlantScaling& scaling);

/// By which L, which acts in flow, or L_c is larger in the units of the plant file, where norms of
/// state and outputs are kept.
double gain_unit(const std::string& gain, const PlantScaling& scaling);

/// What a theorem names, in these units.
NamedMatrices scaled(const Theorem& theorem, const NamedMatrices& values,
                     const PlantScaling& scaling);

/// What a theorem names, from these units back to those of the plant file.
NamedMatrices unscaled(const Theorem& theorem, const NamedMatrices& values,
                       const PlantScaling& scaling);

}  // namespace sampled_data_observers
