#include "design/packing.h"

#include <cstring>
#include <stdexcept>

namespace sampled_data_observers {

void Packer::add(double value) {
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void Packer::add(std::int64_t value) {
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void Packer::add(const std::string& text) {
  add(static_cast<std::int64_t>(text.size()));
  bytes_ += text;
}

void Packer::add(const NamedMatrices& matrices) {
  add(static_cast<std::int64_t>(matrices.size()));
  for (const auto& [name, matrix] : matrices) {
    add(name);
    add(static_cast<std::int64_t>(matrix.rows()));
    add(static_cast<std::int64_t>(matrix.cols()));
    for (Eigen::Index i = 0; i < matrix.size(); ++i) add(matrix.data()[i]);
  }
}

void Unpacker::take(void* data, std::size_t size) {
  if (size > bytes_.size() - at_) throw std::out_of_range("the bytes of a worker end too soon");
  std::memcpy(data, bytes_.data() + at_, size);
  at_ += size;
}

double Unpacker::number() {
  double value = 0.0;
  take(&value, sizeof value);
  return value;
}

std::int64_t Unpacker::integer() {
  std::int64_t value = 0;
  take(&value, sizeof value);
  return value;
}

std::string Unpacker::text() {
  const auto size = static_cast<std::size_t>(integer());
  if (size > bytes_.size() - at_) throw std::out_of_range("the bytes of a worker end too soon");
  std::string text = bytes_.substr(at_, size);
  at_ += size;
  return text;
}

NamedMatrices Unpacker::matrices() {
  NamedMatrices result;
  for (std::int64_t count = integer(); count > 0; --count) {
    const std::string name = text();
    const Eigen::Index rows = integer();
    const Eigen::Index cols = integer();
    Eigen::MatrixXd matrix(rows, cols);
    for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = number();
    result.emplace(name, std::move(matrix));
  }
  return result;
}

}  // namespace sampled_data_observers
