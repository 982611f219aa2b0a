#include "pcednet/io/las/laz_coder.h"

#include <algorithm>

namespace pcednet::io::laz {
namespace {

constexpr unsigned kSymbolShift = 15, kBitShift = 13, kHighBits = 8;
constexpr std::uint32_t kLeastLength = 1U << 24;

}  // namespace

SymbolModel::SymbolModel(unsigned count) : counts_(count, 1), distribution_(count + 1) {
  unsigned table_bits = 0;
  if (count > 16) {
    table_bits = 3;
    while (count > 1U << (table_bits + 2)) ++table_bits;
    table_.resize((std::size_t{1} << table_bits) + 1);
  }
  table_shift_ = kSymbolShift - table_bits;
  cycle_ = count;
  update();
  cycle_ = until_update_ = (count + 6) >> 1;
}

void SymbolModel::update() {
  const auto count = static_cast<std::uint32_t>(counts_.size());
  total_ += cycle_;
  if (total_ > 1U << kSymbolShift) {
    total_ = 0;
    for (std::uint32_t& n : counts_) total_ += (n = (n + 1) >> 1);
  }
  const std::uint32_t scale = 0x80000000U / total_;
  std::uint32_t sum = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    distribution_[s] =
        static_cast<std::uint32_t>((std::uint64_t{scale} * sum) >> (31 - kSymbolShift));
    sum += counts_[s];
  }
  distribution_[count] = 1U << kSymbolShift;
  std::uint32_t symbol = 0;
  for (std::size_t place = 0; place < table_.size(); ++place) {
    while (symbol + 1 < count && distribution_[symbol + 1] <= place << table_shift_) ++symbol;
    table_[place] = static_cast<std::uint16_t>(symbol);
  }
  cycle_ = std::min((5 * cycle_) >> 2, (count + 6) << 3);
  until_update_ = cycle_;
}

unsigned SymbolModel::find(std::uint32_t place) const {
  place = std::min(place, (1U << kSymbolShift) - 1);  // only damaged bytes reach beyond
  unsigned symbol = table_.empty() ? 0 : table_[place >> table_shift_];
  unsigned end = table_.empty() ? last() : table_[(place >> table_shift_) + 1];
  while (symbol < end) {
    const unsigned middle = (symbol + end + 1) / 2;
    if (distribution_[middle] <= place) {
      symbol = middle;
    } else {
      end = middle - 1;
    }
  }
  return symbol;
}

void BitModel::update() {
  total_ += cycle_;
  if (total_ > 1U << kBitShift) {
    total_ = (total_ + 1) >> 1;
    zeros_ = (zeros_ + 1) >> 1;
    if (zeros_ == total_) ++total_;
  }
  const std::uint32_t scale = 0x80000000U / total_;
  probability_ = static_cast<std::uint32_t>((std::uint64_t{zeros_} * scale) >> (31 - kBitShift));
  cycle_ = std::min((5 * cycle_) >> 2, 64U);
  until_update_ = cycle_;
}

void Decoder::start(std::span<const std::byte> bytes) {
  bytes_ = bytes;
  at_ = excess_ = 0;
  length_ = UINT32_MAX;
  value_ = 0;
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next();
}

void Decoder::renormalise() {
  while (length_ < kLeastLength) {
    value_ = value_ << 8 | next();
    length_ <<= 8;
  }
}

unsigned Decoder::bit(BitModel& model, unsigned) {
  const std::uint32_t split = model.zero_probability() * (length_ >> kBitShift);
  const unsigned bit = value_ >= split ? 1 : 0;
  if (bit == 0) {
    length_ = split;
  } else {
    value_ -= split;
    length_ -= split;
  }
  renormalise();
  model.saw(bit);
  return bit;
}

unsigned Decoder::symbol(SymbolModel& model, unsigned) {
  const std::uint32_t unit = length_ >> kSymbolShift;
  const unsigned symbol = model.find(value_ / unit);
  const std::uint32_t begin = model.below(symbol) * unit;
  const std::uint32_t end = symbol == model.last() ? length_ : model.below(symbol + 1) * unit;
  value_ -= begin;
  length_ = end - begin;
  renormalise();
  model.saw(symbol);
  return symbol;
}

std::uint32_t Decoder::bits(unsigned count, std::uint32_t) {
  if (count > 19) {
    const std::uint32_t low = bits(16);
    return bits(count - 16) << 16 | low;
  }
  length_ >>= count;
  const std::uint32_t value = value_ / length_;
  value_ -= length_ * value;
  renormalise();
  return value & ((1U << count) - 1);
}

std::uint32_t Decoder::word(std::uint32_t) {
  const std::uint32_t low = bits(16);
  return bits(16) << 16 | low;
}

void Encoder::add(std::uint32_t amount) {
  base_ += amount;
  if (base_ >= amount) return;
  std::size_t at = bytes_.size();
  while (at > 0 && ++bytes_[at - 1] == 0) --at;
}

void Encoder::renormalise() {
  while (length_ < kLeastLength) {
    bytes_ += static_cast<char>(base_ >> 24);
    base_ <<= 8;
    length_ <<= 8;
  }
}

unsigned Encoder::bit(BitModel& model, unsigned value) {
  const std::uint32_t split = model.zero_probability() * (length_ >> kBitShift);
  if (value == 0) {
    length_ = split;
  } else {
    add(split);
    length_ -= split;
  }
  renormalise();
  model.saw(value);
  return value;
}

unsigned Encoder::symbol(SymbolModel& model, unsigned value) {
  const std::uint32_t unit = length_ >> kSymbolShift;
  const std::uint32_t begin = model.below(value) * unit;
  const std::uint32_t end = value == model.last() ? length_ : model.below(value + 1) * unit;
  add(begin);
  length_ = end - begin;
  renormalise();
  model.saw(value);
  return value;
}

std::uint32_t Encoder::bits(unsigned count, std::uint32_t value) {
  if (count > 19) {
    bits(16, value & 0xFFFFU);
    bits(count - 16, value >> 16);
    return value;
  }
  length_ >>= count;
  add(value * length_);
  renormalise();
  return value;
}

std::uint32_t Encoder::word(std::uint32_t value) {
  bits(16, value & 0xFFFFU);
  bits(16, value >> 16);
  return value;
}

std::string Encoder::finish() {
  const bool another = length_ > 2 * kLeastLength;
  add(another ? kLeastLength : kLeastLength >> 1);
  length_ = another ? kLeastLength >> 1 : kLeastLength >> 9;
  renormalise();
  bytes_.append(another ? 3 : 2, '\0');  // decoders read ahead
  return std::move(bytes_);
}

IntegerModel::IntegerModel(unsigned bits, unsigned contexts)
    : bits_(bits), range_(std::int64_t{1} << bits), lengths_(contexts, SymbolModel(bits + 1)) {
  for (unsigned k = 1; k <= bits; ++k) correctors_.emplace_back(1U << std::min(k, kHighBits));
}

/// A difference modulo the range, in -range/2 ... range/2 - 1.
std::int32_t IntegerModel::fold(std::int64_t difference) const {
  if (difference < -(range_ / 2)) difference += range_;
  if (difference >= range_ / 2) difference -= range_;
  return static_cast<std::int32_t>(difference);
}

template <typename Coder>
std::int32_t IntegerModel::code(Coder& coder, std::int32_t predicted, unsigned context,
                                std::int32_t value) {
  std::int64_t c = 0;
  if constexpr (Coder::kEncodes) {
    c = fold(std::int64_t{value} - predicted);
    k_ = 0;
    for (std::int64_t rest = c <= 0 ? -c : c - 1; rest != 0; rest >>= 1) ++k_;
  }
  k_ = coder.symbol(lengths_[context], k_);
  if (k_ == 0) {
    c = coder.bit(one_, static_cast<unsigned>(c & 1));
  } else if (k_ < 32) {
    // c is -(2^k - 1) ... -2^(k-1) or 2^(k-1) + 1 ... 2^k: counted from 0.
    auto place = static_cast<std::uint32_t>(c < 0 ? c + (std::int64_t{1} << k_) - 1 : c - 1);
    SymbolModel& model = correctors_[k_ - 1];
    if (k_ <= kHighBits) {
      place = coder.symbol(model, place);
    } else {
      const unsigned low_bits = k_ - kHighBits;
      const std::uint32_t high = coder.symbol(model, place >> low_bits);
      place = high << low_bits | coder.bits(low_bits, place & ((1U << low_bits) - 1));
    }
    c = place >= 1U << (k_ - 1) ? std::int64_t{place} + 1
                                : std::int64_t{place} - (std::int64_t{1} << k_) + 1;
  } else {
    c = -(range_ / 2);
  }
  if constexpr (Coder::kEncodes) return value;
  std::int64_t real = std::int64_t{predicted} + c;
  if (bits_ == 32) return static_cast<std::int32_t>(static_cast<std::uint32_t>(real));
  if (real < 0) real += range_;
  if (real >= range_) real -= range_;
  return static_cast<std::int32_t>(real);
}

template std::int32_t IntegerModel::code(Decoder&, std::int32_t, unsigned, std::int32_t);
template std::int32_t IntegerModel::code(Encoder&, std::int32_t, unsigned, std::int32_t);

void Median5::add(std::int32_t value) {
  // The middle of five, one of the outermost giving way: from the top and the bottom in turn.
  auto& v = values_;
  const bool goes_below = value < v[2], goes_above = v[2] < value;
  const auto drop_top = [&] {
    v[4] = v[3];
    v[3] = v[2];
    v[2] = v[1];
  };
  const auto drop_bottom = [&] {
    v[0] = v[1];
    v[1] = v[2];
    v[2] = v[3];
  };
  if (high_) {
    if (!goes_below) {
      v[4] = std::max(v[3], value);
      v[3] = std::min(v[3], value);
      high_ = false;
      return;
    }
    drop_top();
    v[2] = std::max(v[1], value);
    const std::int32_t low = std::min(v[1], value);
    v[1] = std::max(v[0], low);
    v[0] = std::min(v[0], low);
    return;
  }
  if (!goes_above) {
    v[0] = std::min(v[1], value);
    v[1] = std::max(v[1], value);
    high_ = true;
    return;
  }
  drop_bottom();
  v[2] = std::min(v[3], value);
  const std::int32_t high = std::max(v[3], value);
  v[3] = std::min(v[4], high);
  v[4] = std::max(v[4], high);
}

}  // namespace pcednet::io::laz
