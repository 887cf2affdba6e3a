#include "design/yaml_text.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

namespace sampled_data_observers {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0: not UTF-8
};

/// The character at a place of a text in UTF-8.
Character character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return {first, 1};
  Character result;
  std::uint32_t least = 0;
  if (first >= 0xC0 && first < 0xE0) {
    result = {first & 0x1FU, 2};
    least = 0x80;
  } else if (first >= 0xE0 && first < 0xF0) {
    result = {first & 0x0FU, 3};
    least = 0x800;
  } else if (first >= 0xF0 && first < 0xF8) {
    result = {first & 0x07U, 4};
    least = 0x10000;
  }
  if (result.bytes == 0 || at + result.bytes > text.size()) return {};
  for (std::size_t i = 1; i < result.bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    result.code = (result.code << 6U) | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = result.code >= 0xD800 && result.code < 0xE000;
  return result.code < least || result.code > 0x10FFFF || is_surrogate ? Character{} : result;
}

/// Whether YAML 1.1 and 1.2 take it as it is, and not as the end of a line.
bool is_printable(std::uint32_t code) {
  if (code < 0xA0) return code >= 0x20 && code < 0x7F;
  return code != 0x2028 && code != 0x2029 && code != 0xFEFF && code != 0xFFFE && code != 0xFFFF;
}

std::string escaped(std::uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\t') return "\\t";
  char text[16];
  std::snprintf(text, sizeof text, code < 0x100 ? "\\x%02X" : "\\u%04X", code);
  return text;
}

}  // namespace

std::string yaml_scalar(const std::string& text) {
  std::string result = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const Character character = character_at(text, at);
    if (character.bytes == 0) {
      throw std::invalid_argument("expected a text in UTF-8, found other bytes");
    }
    if (character.code == '"' || character.code == '\\') result += '\\';
    result +=
        is_printable(character.code) ? text.substr(at, character.bytes) : escaped(character.code);
    at += character.bytes;
  }
  return result + "\"";
}

std::string yaml_comment(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = character_at(text, at);
    if (character.bytes == 0) {
      result += escaped(static_cast<unsigned char>(text[at++]));
      continue;
    }
    result +=
        is_printable(character.code) ? text.substr(at, character.bytes) : escaped(character.code);
    at += character.bytes;
  }
  return result;
}

}  // namespace sampled_data_observers
