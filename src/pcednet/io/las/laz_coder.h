#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pcednet::io::laz {

/// Adaptive probabilities of `count` symbols.
class SymbolModel {
 public:
  explicit SymbolModel(unsigned count);

  unsigned last() const { return static_cast<unsigned>(counts_.size()) - 1; }
  /// 2^15 times the probability of the symbols before `symbol`.
  std::uint32_t below(unsigned symbol) const { return distribution_[symbol]; }
  /// The symbol with below(symbol) <= `place` < below(symbol + 1).
  unsigned find(std::uint32_t place) const;
  void saw(unsigned symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

 private:
  void update();

  std::vector<std::uint32_t> counts_, distribution_;
  std::vector<std::uint16_t> table_;  ///< where to begin a search, by the high bits of a place
  unsigned table_shift_ = 0;
  std::uint32_t total_ = 0, cycle_ = 0, until_update_ = 0;
};

/// Symbol models made on first use.
class LazyModels {
 public:
  LazyModels(std::size_t count, unsigned symbols) : symbols_(symbols), models_(count) {}
  SymbolModel& operator[](std::size_t index) {
    if (!models_[index]) models_[index] = std::make_unique<SymbolModel>(symbols_);
    return *models_[index];
  }

 private:
  unsigned symbols_;
  std::vector<std::unique_ptr<SymbolModel>> models_;
};

/// The adaptive probability of a bit.
class BitModel {
 public:
  std::uint32_t zero_probability() const { return probability_; }
  void saw(unsigned bit) {
    if (bit == 0) ++zeros_;
    if (--until_update_ == 0) update();
  }

 private:
  void update();

  std::uint32_t zeros_ = 1, total_ = 2, probability_ = 1U << 12, cycle_ = 4, until_update_ = 4;
};

/// The arithmetic decoder of LASzip. Functions take the value to encode and ignore it, so that
/// models can be written once for both directions.
class Decoder {
 public:
  static constexpr bool kEncodes = false;

  void start(std::span<const std::byte> bytes);
  unsigned bit(BitModel& model, unsigned = 0);
  unsigned symbol(SymbolModel& model, unsigned = 0);
  std::uint32_t bits(unsigned count, std::uint32_t = 0);
  std::uint32_t word(std::uint32_t = 0);
  /// Whether more was read than there is: the output is then noise.
  bool overrun() const { return excess_ > 8; }

 private:
  void renormalise();
  std::uint32_t next() {
    if (at_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[at_++]);
    ++excess_;
    return 0;
  }

  std::span<const std::byte> bytes_ = {};
  std::size_t at_ = 0, excess_ = 0;
  std::uint32_t value_ = 0, length_ = UINT32_MAX;
};

/// Its counterpart.
class Encoder {
 public:
  static constexpr bool kEncodes = true;

  unsigned bit(BitModel& model, unsigned value);
  unsigned symbol(SymbolModel& model, unsigned value);
  std::uint32_t bits(unsigned count, std::uint32_t value);
  std::uint32_t word(std::uint32_t value);
  /// The bytes, once everything is encoded; call it once.
  std::string finish();

 private:
  void add(std::uint32_t amount);
  void renormalise();

  std::string bytes_;
  std::uint32_t base_ = 0, length_ = UINT32_MAX;
};

/// Codes numbers near a prediction, by the number of bits of the difference.
class IntegerModel {
 public:
  explicit IntegerModel(unsigned bits, unsigned contexts = 1);

  /// The number: decoded, or `value` encoded.
  template <typename Coder>
  std::int32_t code(Coder& coder, std::int32_t predicted, unsigned context, std::int32_t value = 0);

  /// The number of bits of the last difference.
  unsigned last_bits() const { return k_; }

 private:
  std::int32_t fold(std::int64_t difference) const;

  unsigned bits_, k_ = 0;
  std::int64_t range_;
  std::vector<SymbolModel> lengths_;
  BitModel one_;
  std::vector<SymbolModel> correctors_;
};

/// The running median that LASzip predicts differences with.
class Median5 {
 public:
  std::int32_t get() const { return values_[2]; }
  void add(std::int32_t value);

 private:
  std::array<std::int32_t, 5> values_ = {};
  bool high_ = true;
};

}  // namespace pcednet::io::laz
