#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "messages/definition/plan_compiler.h"
#include "sampled_data_observers/config/topic_config.h"

namespace sampled_data_observers {

/// The covariance R of the values that a source takes from messages, as the messages have it: what
/// stands beside them in types that do. R = scale · S C Sᵀ with C the covariance of the fields and
/// S the scales of the source's values; its diagonal is at least the floor. Fields of different
/// parts of a message are independent. A message that says that it does not know C is taken for one
/// with C = 0.
class CovarianceFields {
 public:
  /// Asks the compiler for all that it takes.
  /// @throws ConfigError for fields that have no covariance.
  CovarianceFields(const TopicSource& source, const MessageDefinition& definition,
                   PlanCompiler& compiler);

  /// How many numbers R has: its lower triangle, row by row.
  std::size_t size() const { return entries_.size(); }

  /// Writes R into memory for size() numbers. Returns false where it is not positive definite, or
  /// C has a negative variance or is not finite.
  bool read(const DecodedMessage& message, double* R);

  /// Where a message has the variances of a field.
  struct Place {
    MessagePath array;      ///< to the matrix, row by row, or the one variance
    std::size_t rows = 1;   ///< of the matrix that it is
    std::size_t index = 0;  ///< of the field in it

    /// To the covariance with another field of the same matrix.
    MessagePath path_with(const Place& other) const;
  };

  /// Nothing where it has none.
  static std::optional<Place> place_of(const MessageDefinition& definition,
                                       const MessageField& field);

  /// To what says whether a covariance is known, and of which type; nothing where nothing does.
  static std::optional<MessagePath> type_of(const MessageDefinition& definition,
                                            const Place& place);

 private:
  struct Entry {
    std::optional<std::size_t> slot;  ///< nothing: it is 0
    double factor = 1.0;
    double floor = 0.0;
    bool is_variance = false;
  };

  static std::string member_at(const MessageDefinition& definition, const MessagePath& path,
                               std::size_t depth);
  void add(const TopicSource& source, const Place& row, const Place& column, std::size_t i,
           std::size_t j, PlanCompiler& compiler);

  std::vector<Entry> entries_;
  /// Slots of what says of which type a covariance is; 0: it is not known.
  std::vector<std::size_t> types_;
  std::size_t outputs_ = 0;
  std::vector<double> factor_;  ///< room for a decomposition
};

}  // namespace sampled_data_observers
