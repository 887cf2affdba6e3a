#include "replay/report/packed_array.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace sampled_data_observers {
namespace {

constexpr float kNotFinite = std::numeric_limits<float>::quiet_NaN();

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < present ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= present ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

template <class Number>
nlohmann::json packed_as(const char* type, const std::vector<Number>& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * sizeof(Number));
  for (const Number value : values) {
    for (std::size_t k = 0; k < sizeof(Number); ++k) {
      bytes.push_back(static_cast<std::uint8_t>(value >> (8U * k) & 255U));
    }
  }
  return {{"type", type}, {"data", base64(bytes)}};
}

float narrowed(double value) {
  return std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())
             ? static_cast<float>(value)
             : kNotFinite;
}

}  // namespace

nlohmann::json packed(const std::vector<std::uint8_t>& values) { return packed_as("u8", values); }

nlohmann::json packed(const std::vector<std::uint16_t>& values) { return packed_as("u16", values); }

nlohmann::json packed(const std::vector<std::uint32_t>& values) { return packed_as("u32", values); }

nlohmann::json packed(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits(values.size());
  std::memcpy(bits.data(), values.data(), values.size() * sizeof(float));
  nlohmann::json json = packed(bits);
  json["type"] = "f32";
  return json;
}

nlohmann::json packed(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double middle = low <= high ? low / 2 + high / 2 : 0.0;
  std::vector<float> distances;
  distances.reserve(values.size());
  for (const double value : values) distances.push_back(narrowed(value - middle));
  nlohmann::json json = packed(distances);
  json["offset"] = middle;
  return json;
}

PackedTime PackedTime::of_run(Stamp first, Stamp last) {
  constexpr Duration kMicrosecond = 1000;
  constexpr Duration kMost = std::numeric_limits<std::uint32_t>::max();
  PackedTime time;
  time.origin = first;
  time.unit = std::max(kMicrosecond, (last - first) / kMost + 1);
  return time;
}

std::uint32_t PackedTime::operator()(Stamp stamp) const {
  const Duration count = (stamp - origin + unit / 2) / unit;
  constexpr Duration kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::clamp(count, Duration{0}, kMost));
}

nlohmann::json packed(const std::vector<Stamp>& stamps, const PackedTime& time) {
  std::vector<std::uint32_t> counts;
  counts.reserve(stamps.size());
  for (const Stamp stamp : stamps) counts.push_back(time(stamp));
  return packed(counts);
}

std::vector<double> wrapped(const Quantity& quantity, std::vector<double> values) {
  if (quantity.angular) {
    std::transform(values.begin(), values.end(), values.begin(), wrap_angle);
  }
  return values;
}

nlohmann::json ThinnedSeries::times(const std::vector<Stamp>& stamps,
                                    const PackedTime& time) const {
  std::vector<Stamp> first;
  for (std::size_t i = 0; i < stamps.size(); i += stride_) first.push_back(stamps[i]);
  return packed(first, time);
}

ThinnedSeries::Bins ThinnedSeries::bins_of(const std::vector<double>& values) const {
  Bins bins;
  for (std::size_t i = 0; i < values.size(); i += stride_) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(i + stride_, values.size()));
    const bool is_finite =
        std::all_of(begin, end, [](double value) { return std::isfinite(value); });
    const auto [least, largest] = std::minmax_element(begin, end);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    bins.low.push_back(is_finite ? *least : kNone);
    bins.high.push_back(is_finite ? *largest : kNone);
  }
  return bins;
}

nlohmann::json ThinnedSeries::values(const std::vector<double>& values) const {
  if (stride_ == 1) return {{"low", packed(values)}};
  const Bins bins = bins_of(values);
  return {{"low", packed(bins.low)}, {"high", packed(bins.high)}};
}

nlohmann::json ThinnedSeries::sizes(const std::vector<double>& values) const {
  const auto as_they_are = [](const std::vector<double>& all) {
    std::vector<float> narrow(all.size());
    std::transform(all.begin(), all.end(), narrow.begin(), narrowed);
    return packed(narrow);
  };
  if (stride_ == 1) return {{"low", as_they_are(values)}};
  const Bins bins = bins_of(values);
  return {{"low", as_they_are(bins.low)}, {"high", as_they_are(bins.high)}};
}

}  // namespace sampled_data_observers
