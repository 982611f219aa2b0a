#include "pcednet/io/las/laz_items.h"

#include <algorithm>
#include <cmath>

#include "pcednet/core/bytes.h"

namespace pcednet::io::laz {
namespace {

/// The contexts of a return number (column) for a number of returns (row).
constexpr std::uint8_t kReturnContext10[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
    {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
    {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15}};

int clamp_byte(int value) {
  return std::clamp(value, 0, 255);
}

int low(std::uint16_t word) {
  return word & 0xFF;
}

int high(std::uint16_t word) {
  return word >> 8;
}

/// A byte near a predicted one.
template <typename Coder>
int code_byte(Coder& coder, SymbolModel& model, int predicted, int value) {
  const auto difference = static_cast<std::uint8_t>(value - predicted);
  return static_cast<std::uint8_t>(predicted + static_cast<int>(coder.symbol(model, difference)));
}

std::uint16_t word_of(int low_byte, int high_byte) {
  return static_cast<std::uint16_t>(low_byte | high_byte << 8);
}

}  // namespace

Point10::Point10(const std::byte* first) {
  std::memcpy(last_.data(), first, last_.size());
  store<std::uint16_t>(&last_[12], 0);
}

template <typename Coder>
void Point10::code(Coder& coder, std::byte* item) {
  std::byte* last = last_.data();
  const auto byte = [](const std::byte* at) { return std::to_integer<unsigned>(*at); };
  unsigned changed = 0;
  if constexpr (Coder::kEncodes) {
    const unsigned m = kReturnContext10[byte(item + 14) >> 3 & 7][byte(item + 14) & 7];
    changed = (item[14] != last[14] ? 32U : 0U) |
              (load<std::uint16_t>(item + 12) != intensity_[m] ? 16U : 0U) |
              (item[15] != last[15] ? 8U : 0U) | (item[16] != last[16] ? 4U : 0U) |
              (item[17] != last[17] ? 2U : 0U) |
              (load<std::uint16_t>(item + 18) != load<std::uint16_t>(last + 18) ? 1U : 0U);
  }
  changed = coder.symbol(changed_, changed);
  const auto code_symbol = [&](unsigned flag, LazyModels& models, std::size_t at) {
    if (changed & flag) {
      last[at] = std::byte(coder.symbol(models[byte(last + at)], byte(item + at)));
    }
  };
  code_symbol(32, flags_, 14);
  const unsigned r = byte(last + 14) & 7, n = byte(last + 14) >> 3 & 7;
  const unsigned m = kReturnContext10[n][r], l = n > r ? n - r : r - n;
  if (changed & 16) {
    intensity_[m] =
        intensities_.code(coder, intensity_[m], std::min(m, 3U), load<std::uint16_t>(item + 12));
  }
  store(last + 12, static_cast<std::uint16_t>(intensity_[m]));
  code_symbol(8, classification_, 15);
  if (changed & 4) {
    last[16] =
        std::byte(code_byte(coder, scan_angle_[byte(last + 14) >> 6 & 1],
                            static_cast<int>(byte(last + 16)), static_cast<int>(byte(item + 16))));
  }
  code_symbol(2, user_data_, 17);
  if (changed & 1) {
    store(last + 18, static_cast<std::uint16_t>(source_.code(coder, load<std::uint16_t>(last + 18),
                                                             0, load<std::uint16_t>(item + 18))));
  }
  code_position(coder, item, m, l, n == 1);
  std::memcpy(item, last, last_.size());
}

template <typename Coder>
void Point10::code_position(Coder& coder, std::byte* item, unsigned m, unsigned l, bool single) {
  std::byte* last = last_.data();
  const unsigned one = single ? 1 : 0;
  code_axis(coder, dx_, x_[m], one, last, item);
  code_axis(coder, dy_, y_[m], one + even_bits(dx_.last_bits(), 20), last + 4, item + 4);
  const unsigned bits = (dx_.last_bits() + dy_.last_bits()) / 2;
  height_[l] = z_.code(coder, height_[l], one + even_bits(bits, 18), load<std::int32_t>(item + 8));
  store(last + 8, height_[l]);
}

GpsTime::GpsTime(std::int64_t first, bool says_unchanged)
    : says_unchanged_(says_unchanged),
      multiple_(says_unchanged ? 516 : 515),
      first_(says_unchanged ? 6 : 5) {
  times_[0] = first;
}

void GpsTime::count_extreme(std::int32_t difference) {
  if (++extremes_[last_] <= 3) return;
  differences_[last_] = difference;
  extremes_[last_] = 0;
}

namespace {

constexpr unsigned kUnchanged = 511, kFull = 512;
constexpr int kMost = 500, kLeast = -10;

bool fits_32(std::int64_t value) {
  return value >= INT32_MIN && value <= INT32_MAX;
}

std::int64_t minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::int32_t times(int factor, std::int32_t value) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(factor) *
                                   static_cast<std::uint32_t>(value));
}

}  // namespace

/// The symbol for a time: of the first difference of a sequence (0 unchanged, 1 near, 2 full, 3 to
/// 5 another sequence) or of the multiples (kUnchanged, kFull, above it another sequence).
unsigned GpsTime::choose(std::int64_t time, bool no_difference) const {
  const std::int64_t away = minus(time, times_[last_]);
  if (away == 0 && says_unchanged_) return no_difference ? 0 : kUnchanged;
  if (!fits_32(away)) {
    for (unsigned other = 1; other < 4; ++other) {
      if (!fits_32(minus(time, times_[(last_ + other) & 3]))) continue;
      return (no_difference ? 2 : kFull) + other;
    }
    return no_difference ? 2 : kFull;
  }
  if (no_difference) return 1;
  const double ratio = static_cast<double>(away) / differences_[last_];
  const int multiple = static_cast<int>(std::lround(std::clamp(ratio, -1e6, 1e6)));
  if (multiple >= 0) return static_cast<unsigned>(std::min(multiple, kMost));
  return static_cast<unsigned>(kMost - std::max(multiple, kLeast));
}

template <typename Coder>
void GpsTime::code_full(Coder& coder, std::int64_t& time) {
  const auto high_word = static_cast<std::int32_t>(times_[last_] >> 32);
  next_ = (next_ + 1) & 3;
  const auto high_half = static_cast<std::uint32_t>(
      numbers_.code(coder, high_word, 8, static_cast<std::int32_t>(time >> 32)));
  const std::uint32_t low_half = coder.word(static_cast<std::uint32_t>(time));
  last_ = next_;
  time = static_cast<std::int64_t>(std::uint64_t{high_half} << 32 | low_half);
  times_[last_] = time;
  differences_[last_] = 0;
  extremes_[last_] = 0;
}

/// A time that is a multiple of the last difference, or nearly.
template <typename Coder>
void GpsTime::code_near(Coder& coder, std::int64_t& time) {
  const unsigned shift = says_unchanged_ ? 0 : 1;
  const bool no_difference = differences_[last_] == 0;
  SymbolModel& model = no_difference ? first_ : multiple_;
  const unsigned first_code = no_difference ? 0 : kUnchanged;
  unsigned symbol = 0;
  if constexpr (Coder::kEncodes) {
    symbol = choose(time, no_difference);
    if (symbol >= first_code) symbol -= shift;
  }
  symbol = coder.symbol(model, symbol);
  if (symbol >= first_code) symbol += shift;
  if (symbol == first_code && says_unchanged_) {
    time = times_[last_];
    return;
  }
  const unsigned full = no_difference ? 2 : kFull;
  if (symbol == full) return code_full(coder, time);
  if (symbol > full) {
    last_ = (last_ + symbol - full) & 3;
    return code_near(coder, time);
  }
  const auto away = static_cast<std::int32_t>(minus(time, times_[last_]));
  const std::int32_t unit = differences_[last_];
  std::int32_t difference = 0;
  const auto code_number = [&](std::int32_t predicted, unsigned context) {
    difference = numbers_.code(coder, predicted, context, away);
  };
  if (no_difference || symbol == 1) {
    code_number(unit, no_difference ? 0 : 1);
    if (no_difference) differences_[last_] = difference;
    extremes_[last_] = 0;
  } else if (symbol == 0) {
    code_number(0, 7);
    count_extreme(difference);
  } else if (symbol < kMost) {
    code_number(times(static_cast<int>(symbol), unit), symbol < 10 ? 2 : 3);
  } else if (symbol == kMost) {
    code_number(times(kMost, unit), 4);
    count_extreme(difference);
  } else {
    const int multiple = kMost - static_cast<int>(symbol);
    code_number(times(multiple, unit), multiple > kLeast ? 5 : 6);
    if (multiple <= kLeast) count_extreme(difference);
  }
  times_[last_] = static_cast<std::int64_t>(static_cast<std::uint64_t>(times_[last_]) +
                                            static_cast<std::uint64_t>(std::int64_t{difference}));
  time = times_[last_];
}

template <typename Coder>
void GpsTime::code(Coder& coder, std::byte* item) {
  auto time = load<std::int64_t>(item);
  code_near(coder, time);
  store(item, time);
}

template <typename Coder>
void Colour::code(Coder& coder, std::byte* item) {
  auto now = load<Words>(item);
  unsigned used = 0;
  if constexpr (Coder::kEncodes) {
    for (unsigned c = 0; c < 3; ++c) {
      if (low(now[c]) != low(last[c])) used |= 1U << (2 * c);
      if (high(now[c]) != high(last[c])) used |= 2U << (2 * c);
    }
    if (now[0] != now[1] || now[0] != now[2]) used |= 64;
  }
  used = coder.symbol(used_, used);
  const auto byte = [&](unsigned b, int predicted, int before, int value) {
    return used >> b & 1 ? code_byte(coder, differences_[b], predicted, value) : before;
  };
  std::array<int, 3> lows = {}, highs = {};
  lows[0] = byte(0, low(last[0]), low(last[0]), low(now[0]));
  highs[0] = byte(1, high(last[0]), high(last[0]), high(now[0]));
  if (used & 64) {
    const auto code_two = [&](std::array<int, 3>& bytes, unsigned b, int (*part)(std::uint16_t)) {
      int change = bytes[0] - part(last[0]);
      bytes[1] = byte(b, clamp_byte(change + part(last[1])), part(last[1]), part(now[1]));
      change = (change + bytes[1] - part(last[1])) / 2;
      bytes[2] = byte(b + 2, clamp_byte(change + part(last[2])), part(last[2]), part(now[2]));
    };
    code_two(lows, 2, low);
    code_two(highs, 3, high);
  } else {
    lows[1] = lows[2] = lows[0];
    highs[1] = highs[2] = highs[0];
  }
  for (std::size_t c = 0; c < 3; ++c) last[c] = word_of(lows[c], highs[c]);
  store(item, last);
}

template <typename Coder>
void Infrared::code(Coder& coder, std::byte* item) {
  const auto now = load<std::uint16_t>(item);
  unsigned used = 0;
  if constexpr (Coder::kEncodes) {
    used = (low(now) != low(last) ? 1U : 0U) | (high(now) != high(last) ? 2U : 0U);
  }
  used = coder.symbol(used_, used);
  int low_byte = low(last), high_byte = high(last);
  if (used & 1) low_byte = code_byte(coder, differences_[0], low_byte, low(now));
  if (used & 2) high_byte = code_byte(coder, differences_[1], high_byte, high(now));
  last = word_of(low_byte, high_byte);
  store(item, last);
}

template <typename Coder>
void WavePacket::code(Coder& coder, std::byte* item) {
  const auto before = load<std::uint64_t>(&last[1]);
  const auto size_before = load<std::uint32_t>(&last[9]);
  const auto now = load<std::uint64_t>(item + 1);
  last[0] = std::byte(coder.symbol(index_, std::to_integer<unsigned>(item[0])));
  const auto away = static_cast<std::int64_t>(now - before);
  unsigned kind = 0;
  if constexpr (Coder::kEncodes) {
    kind = away == 0 ? 0 : now == before + size_before ? 1 : fits_32(away) ? 2 : 3;
  }
  kind = coder.symbol(offset_kinds_[offset_kind_], kind);
  offset_kind_ = kind;
  std::uint64_t offset = before;
  if (kind == 1) offset += size_before;
  if (kind == 2) {
    difference_ = offset_.code(coder, difference_, 0, static_cast<std::int32_t>(away));
    offset += static_cast<std::uint64_t>(std::int64_t{difference_});
  } else if (kind == 3) {
    const std::uint32_t low_half = coder.word(static_cast<std::uint32_t>(now));
    offset = std::uint64_t{coder.word(static_cast<std::uint32_t>(now >> 32))} << 32 | low_half;
  }
  store(&last[1], offset);
  const auto code_number = [&](IntegerModel& model, unsigned context, std::size_t at) {
    store(&last[at],
          model.code(coder, load<std::int32_t>(&last[at]), context, load<std::int32_t>(item + at)));
  };
  code_number(size_, 0, 9);
  code_number(location_, 0, 13);
  for (unsigned axis = 0; axis < 3; ++axis) code_number(vector_, axis, 17 + 4 * axis);
  std::memcpy(item, last.data(), last.size());
}

template <typename Coder>
void ExtraByte::code(Coder& coder, std::byte* item) {
  const int value =
      code_byte(coder, model_, std::to_integer<int>(last), std::to_integer<int>(*item));
  last = *item = std::byte(value);
}

template void Point10::code(Decoder&, std::byte*);
template void Point10::code(Encoder&, std::byte*);
template void GpsTime::code(Decoder&, std::byte*);
template void GpsTime::code(Encoder&, std::byte*);
template void Colour::code(Decoder&, std::byte*);
template void Colour::code(Encoder&, std::byte*);
template void Infrared::code(Decoder&, std::byte*);
template void Infrared::code(Encoder&, std::byte*);
template void WavePacket::code(Decoder&, std::byte*);
template void WavePacket::code(Encoder&, std::byte*);
template void ExtraByte::code(Decoder&, std::byte*);
template void ExtraByte::code(Encoder&, std::byte*);

}  // namespace pcednet::io::laz
