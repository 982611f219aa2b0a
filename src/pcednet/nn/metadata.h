#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace pcednet::nn {

/// Names of the values of an enum, in files.
template <typename T, std::size_t N>
using Names = std::array<std::pair<T, std::string_view>, N>;

/// The metadata of a model file, consumed key by key. Every function throws Error(kModelMismatch),
/// naming the file, on failure.
class Metadata {
 public:
  Metadata(std::map<std::string, std::string> values, std::string file)
      : values_(std::move(values)), file_(std::move(file)) {}

  [[noreturn]] void refuse(const std::string& why) const;

  bool has(const std::string& key) const { return values_.contains(key); }
  std::string take(const std::string& key);

  /// Takes a value that must be `wanted`.
  void take_fixed(const std::string& key, std::string_view wanted);

  /// A finite number.
  template <typename Number>
  Number take_number(const std::string& key) {
    const std::string text = take(key);
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    const bool is_read = error == std::errc() && stop == end;
    if (!is_read || !std::isfinite(static_cast<double>(number))) refuse_value(key, text);
    return number;
  }

  template <typename T, std::size_t N>
  T take_choice(const std::string& key, const Names<T, N>& names) {
    const std::string text = take(key);
    for (const auto& [value, name] : names) {
      if (name == text) return value;
    }
    refuse_value(key, text);
  }

  [[noreturn]] void refuse_value(const std::string& key, const std::string& value) const;

  /// Everything not taken.
  std::map<std::string, std::string>& rest() { return values_; }

 private:
  std::map<std::string, std::string> values_;
  std::string file_;
};

}  // namespace pcednet::nn
