#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pcednet/core/bytes.h"
#include "pcednet/io/las/laz_coder.h"

namespace pcednet::io::laz {

// The models of LASzip's items, by its specification. `code` decodes an item into `item`, or
// encodes it from there, depending on the coder.

/// The low bit of a context number cleared, bounded.
inline unsigned even_bits(unsigned bits, unsigned most) {
  return bits < most ? bits & ~1U : most;
}

/// A coordinate, by the median of its last differences; `last` becomes the value in `item`.
template <typename Coder>
void code_axis(Coder& coder, IntegerModel& model, Median5& median, unsigned context,
               std::byte* last, const std::byte* item) {
  const auto before = load<std::uint32_t>(last);
  const auto wanted = static_cast<std::int32_t>(load<std::uint32_t>(item) - before);
  const std::int32_t difference = model.code(coder, median.get(), context, wanted);
  median.add(difference);
  store(last, before + static_cast<std::uint32_t>(difference));
}

/// POINT10: the 20 bytes that formats 0 to 5 share.
class Point10 {
 public:
  explicit Point10(const std::byte* first);
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

 private:
  template <typename Coder>
  void code_position(Coder& coder, std::byte* item, unsigned m, unsigned l, bool single);

  std::array<std::byte, 20> last_ = {};
  std::array<Median5, 16> x_ = {}, y_ = {};
  std::array<std::int32_t, 16> intensity_ = {};
  std::array<std::int32_t, 8> height_ = {};
  SymbolModel changed_{64};
  LazyModels flags_{256, 256}, classification_{256, 256}, user_data_{256, 256};
  LazyModels scan_angle_{2, 256};
  IntegerModel dx_{32, 2}, dy_{32, 22}, z_{32, 20}, intensities_{16, 4}, source_{16};
};

/// Times as multiples of earlier differences, in up to four sequences. POINT14 signals an unchanged
/// time by other means, and has no symbols for it.
class GpsTime {
 public:
  GpsTime(std::int64_t first, bool says_unchanged);
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

 private:
  template <typename Coder>
  void code_near(Coder& coder, std::int64_t& time);
  unsigned choose(std::int64_t time, bool no_difference) const;
  template <typename Coder>
  void code_full(Coder& coder, std::int64_t& time);
  void count_extreme(std::int32_t difference);

  bool says_unchanged_;
  std::size_t last_ = 0, next_ = 0;
  std::array<std::int64_t, 4> times_ = {};
  std::array<std::int32_t, 4> differences_ = {};
  std::array<unsigned, 4> extremes_ = {};
  SymbolModel multiple_, first_;
  IntegerModel numbers_{32, 9};
};

/// RGB12 and RGB14.
class Colour {
 public:
  explicit Colour(const std::byte* first) { last = load<Words>(first); }
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

  using Words = std::array<std::uint16_t, 3>;
  Words last;

 private:
  SymbolModel used_{128};
  LazyModels differences_{6, 256};
};

/// The infrared of RGBNIR14.
class Infrared {
 public:
  explicit Infrared(const std::byte* first) : last(load<std::uint16_t>(first)) {}
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

  std::uint16_t last;

 private:
  SymbolModel used_{4};
  LazyModels differences_{2, 256};
};

/// WAVEPACKET13 and WAVEPACKET14: 29 bytes.
class WavePacket {
 public:
  explicit WavePacket(const std::byte* first) { std::memcpy(last.data(), first, last.size()); }
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

  std::array<std::byte, 29> last;

 private:
  std::int32_t difference_ = 0;
  unsigned offset_kind_ = 0;
  SymbolModel index_{256};
  LazyModels offset_kinds_{4, 4};
  IntegerModel offset_{32}, size_{32}, location_{32}, vector_{32, 3};
};

/// One extra byte.
class ExtraByte {
 public:
  explicit ExtraByte(const std::byte* first) : last(*first) {}
  template <typename Coder>
  void code(Coder& coder, std::byte* item);

  std::byte last;

 private:
  SymbolModel model_{256};
};

}  // namespace pcednet::io::laz
