#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sampled_data_observers {

// Durations are whole nanoseconds, written in base 64: what a flow does is tabulated for each digit
// d at each place k, that is for d 64^k ns.
constexpr int kDigitBits = 6;
constexpr int kDigits = 1 << kDigitBits;
constexpr int kPlaces = (63 + kDigitBits - 1) / kDigitBits;

/// The step of 2^times as long a time.
template <class Step>
Step doubled(Step step, int times) {
  for (int i = 0; i < times && step.is_finite(); ++i) step = compose(step, step);
  return step;
}

/// The tables of a flow: `block` numbers for each digit d but 0 at each place k, those of d at k at
/// (63 k + d − 1) block. They end before what overflows, as an unstable plant's later transitions
/// do, and with the last digit that a duration has.
///
/// A Step is what the flow does in some time. It has is_finite(), whether all of it is as a double,
/// and compose(Step, Step) gives the step of both.
/// @param none       the step of no time
/// @param unit       unit(scale) is the step of `scale` nanoseconds
/// @param doublings  doublings(scale): how often a shorter step is doubled() for that; 6 more times
/// for
///                   the next place, where it is at all
/// @param write      write(step, numbers) puts what is needed of a step into its block of zeros
template <class Step, class Unit, class Doublings, class Write>
std::vector<double> digit_tables(std::size_t block, const Step& none, const Unit& unit,
                                 const Doublings& doublings, const Write& write) {
  constexpr std::size_t kComposed = kDigits / 2;  // larger digits are no part of others
  constexpr std::size_t kDigitsOfLastPlace = std::size_t{1} << (63 - kDigitBits * (kPlaces - 1));
  constexpr std::size_t kBlocks = (kDigits - 1) * (kPlaces - 1) + kDigitsOfLastPlace - 1;
  std::vector<double> tables;
  tables.reserve(block * kBlocks);
  Step first = none;
  bool is_doubled = false;
  for (int place = 0; place < kPlaces; ++place) {
    const long double scale = std::ldexp(1.0L, kDigitBits * place);
    first = is_doubled ? doubled(std::move(first), kDigitBits) : unit(scale);
    is_doubled = is_doubled || doublings(scale) > 0;
    const std::size_t end = place + 1 < kPlaces ? kDigits : kDigitsOfLastPlace;
    std::vector<Step> digits = {none};
    for (std::size_t d = 1; d < end; ++d) {
      Step step = d > 1 ? compose(digits[d / 2], digits[d - d / 2]) : first;
      if (!step.is_finite()) {
        tables.shrink_to_fit();
        return tables;
      }
      tables.resize(tables.size() + block);
      write(step, tables.data() + tables.size() - block);
      if (d <= kComposed) digits.push_back(std::move(step));
    }
  }
  return tables;
}

/// The blocks of the digits of a duration that are not zero, least first.
struct DigitBlocks {
  const double* of[kPlaces];
  int count = 0;
};

/// Finds those of a duration >= 0. Returns false where the flow over it overflows.
inline bool find_digits(std::int64_t duration, const std::vector<double>& tables, std::size_t block,
                        DigitBlocks& blocks) {
  for (std::size_t place = 0; duration > 0; duration >>= kDigitBits, place += kDigits - 1) {
    const auto digit = static_cast<std::size_t>(duration & (kDigits - 1));
    if (digit == 0) continue;
    const std::size_t at = (place + digit - 1) * block;
    if (at >= tables.size()) return false;
    blocks.of[blocks.count++] = tables.data() + at;
  }
  return true;
}

}  // namespace sampled_data_observers
