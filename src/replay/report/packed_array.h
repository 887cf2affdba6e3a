#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "replay/comparison.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

// Arrays as a page holds them: little-endian numbers in base64, which a browser reads in a blink
// where digits would take seconds. {"type": "u8" | "u16" | "u32" | "f32", "data": ...}.

nlohmann::json packed(const std::vector<std::uint8_t>& values);
nlohmann::json packed(const std::vector<std::uint16_t>& values);
nlohmann::json packed(const std::vector<std::uint32_t>& values);
nlohmann::json packed(const std::vector<float>& values);

/// With single precision of their distances from the middle of their range, the "offset": of
/// coordinates of a map, with single precision of a map's width. What is not finite becomes NaN.
nlohmann::json packed(const std::vector<double>& values);

/// How a page holds times: as whole numbers of `unit` since `origin`.
struct PackedTime {
  Stamp origin = 0;
  Duration unit = 1000;  ///< ns, >= 1

  /// Of a microsecond each, or as many as the length of a run asks for.
  static PackedTime of_run(Stamp first, Stamp last);

  /// What lies before the origin is moved there, what is too late to the last one.
  std::uint32_t operator()(Stamp stamp) const;
};

nlohmann::json packed(const std::vector<Stamp>& stamps, const PackedTime& time);

/// Wrapped where the quantity is an angle.
std::vector<double> wrapped(const Quantity& quantity, std::vector<double> values);

/// Values that share their stamps, thinned for a page: of each `stride` stamps the least and the
/// largest value stay. Where one of them is not finite, neither is what stays.
class ThinnedSeries {
 public:
  /// @pre stride >= 1
  explicit ThinnedSeries(std::size_t stride) : stride_(stride) {}

  /// The first stamp of each bin.
  nlohmann::json times(const std::vector<Stamp>& stamps, const PackedTime& time) const;

  /// {"low": packed, "high": packed}; with a stride of 1 no "high", which would be the same.
  nlohmann::json values(const std::vector<double>& values) const;

  /// The same of sizes that a logarithmic axis shows: with single precision of each.
  nlohmann::json sizes(const std::vector<double>& values) const;

 private:
  /// The least and the largest value of each bin.
  struct Bins {
    std::vector<double> low;
    std::vector<double> high;
  };
  Bins bins_of(const std::vector<double>& values) const;

  std::size_t stride_;
};

}  // namespace sampled_data_observers
