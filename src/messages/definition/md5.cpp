#include "messages/definition/md5.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sampled_data_observers {
namespace {

using Words = std::array<std::uint32_t, 16>;
using Sum = std::array<std::uint32_t, 4>;

constexpr std::size_t kBlock = 64;

std::uint32_t rotated(std::uint32_t word, unsigned bits) {
  return (word << bits) | (word >> (32U - bits));
}

/// RFC 1321, 3.4: T[i] is the integer part of 2^32 |sin i|, i = 1 … 64.
std::uint32_t sine_constant(unsigned i) {
  return static_cast<std::uint32_t>(std::floor(std::ldexp(std::abs(std::sin(i + 1.0)), 32)));
}

void add_block(const Words& words, Sum& sum) {
  constexpr unsigned kShifts[4][4] = {
      {7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
  auto [a, b, c, d] = sum;
  for (unsigned i = 0; i < 64; ++i) {
    std::uint32_t mixed = 0;
    unsigned word = i;
    switch (i / 16) {
      case 0:
        mixed = (b & c) | (~b & d);
        break;
      case 1:
        mixed = (d & b) | (~d & c);
        word = 5 * i + 1;
        break;
      case 2:
        mixed = b ^ c ^ d;
        word = 3 * i + 5;
        break;
      default:
        mixed = c ^ (b | ~d);
        word = 7 * i;
    }
    mixed += a + sine_constant(i) + words[word % 16];
    a = d;
    d = c;
    c = b;
    b += rotated(mixed, kShifts[i / 16][i % 4]);
  }
  sum = {sum[0] + a, sum[1] + b, sum[2] + c, sum[3] + d};
}

/// RFC 1321, 3.1 and 3.2: a bit, zeros, and the length in bits.
std::string padded(std::string text) {
  std::uint64_t bits = std::uint64_t{8} * text.size();
  text += static_cast<char>(0x80);
  while (text.size() % kBlock != kBlock - 8) text += '\0';
  for (int i = 0; i < 8; ++i, bits >>= 8U) text += static_cast<char>(bits & 0xFFU);
  return text;
}

}  // namespace

std::string md5_of(const std::string& text) {
  const std::string bytes = padded(text);
  Sum sum = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
  for (std::size_t block = 0; block < bytes.size(); block += kBlock) {
    Words words{};
    for (std::size_t i = 0; i < kBlock; ++i) {
      words[i / 4] |= std::uint32_t{static_cast<unsigned char>(bytes[block + i])} << (8 * (i % 4));
    }
    add_block(words, sum);
  }
  std::string digits;
  for (const std::uint32_t word : sum) {
    for (unsigned i = 0; i < 4; ++i) {
      const std::uint32_t byte = (word >> (8 * i)) & 0xFFU;
      digits += "0123456789abcdef"[byte >> 4U];
      digits += "0123456789abcdef"[byte & 0xFU];
    }
  }
  return digits;
}

}  // namespace sampled_data_observers
