#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sampled_data_observers {

// Durations are whole nanoseconds, written in base 64: what a flow does is tabulated for each digit
// d at each place k, that is for d 64^k ns.
constexpr int kDigitBits = 6;
constexpr int kDigits = 1 << kDigitBits;
constexpr int kPlaces = (63 + kDigitBits - 1) / kDigitBits;

/// The tables of a flow: `block` numbers for each digit at each place, those of d at k at
/// (64 k + d) block. What overflows, as an unstable plant's later transitions do, and all behind it
/// is infinite.
///
/// A Step is what the flow does in some time. It has is_finite() and write(double* block), and
/// compose(Step, Step) gives the step of both.
/// @param none  the step of no time
/// @param unit  unit(scale) is the step of `scale` nanoseconds
template <class Step, class Unit>
std::vector<double> digit_tables(std::size_t block, const Step& none, const Unit& unit) {
  std::vector<double> tables(block * kDigits * kPlaces, std::numeric_limits<double>::infinity());
  double* table = tables.data();
  for (int place = 0; place < kPlaces; ++place) {
    std::vector<Step> digits = {none, unit(std::ldexp(1.0L, kDigitBits * place))};
    for (std::size_t d = 2; d < kDigits && digits.back().is_finite(); ++d) {
      digits.push_back(compose(digits[d / 2], digits[d - d / 2]));
    }
    for (const Step& digit : digits) {
      // Arithmetic on infinities takes ages.
      if (!digit.is_finite()) return tables;
      digit.write(table);
      table += block;
    }
  }
  return tables;
}

/// Calls apply(table) with the block of each digit of a duration that is not zero.
template <class Apply>
void for_each_digit(std::int64_t duration, const std::vector<double>& tables, std::size_t block,
                    const Apply& apply) {
  const double* place = tables.data();
  for (; duration > 0; duration >>= kDigitBits, place += block * kDigits) {
    const auto digit = static_cast<std::size_t>(duration & (kDigits - 1));
    if (digit != 0) apply(place + digit * block);
  }
}

}  // namespace sampled_data_observers
