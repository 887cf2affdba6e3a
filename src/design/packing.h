#pragma once

#include <cstdint>
#include <string>

#include "certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// Values as bytes, between processes of one program.
class Packer {
 public:
  void add(double value);
  void add(std::int64_t value);
  void add(const std::string& text);
  void add(const NamedMatrices& matrices);

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads back what a Packer added, in the same order.
class Unpacker {
 public:
  /// @param bytes  must outlive the Unpacker
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}

  // All throw std::out_of_range at the end of the bytes.
  double number();
  std::int64_t integer();
  std::string text();
  NamedMatrices matrices();

 private:
  void take(void* data, std::size_t size);

  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace sampled_data_observers
