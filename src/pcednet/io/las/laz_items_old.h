#pragma once

#include "pcednet/io/las/laz_items.h"

namespace pcednet::io::laz {

// The models of LASzip's items in their first version, which are only read.

/// POINT10 of LASzip 1.
class Point10Old {
 public:
  explicit Point10Old(const std::byte* first);
  void code(Decoder& coder, std::byte* item);

 private:
  std::array<std::byte, 20> last_ = {};
  std::array<std::array<std::int32_t, 3>, 2> diffs_ = {};
  std::size_t turn_ = 0;
  SymbolModel changed_{64};
  LazyModels flags_{256, 256}, classification_{256, 256}, user_data_{256, 256};
  IntegerModel dx_{32}, dy_{32, 20}, z_{32, 20}, intensity_{16}, scan_angle_{8, 2}, source_{16};
};

/// GPSTIME11 of LASzip 1.
class GpsTimeOld {
 public:
  explicit GpsTimeOld(std::int64_t first) : last_(first) {}
  void code(Decoder& coder, std::byte* item);

 private:
  std::int64_t last_;
  std::int32_t difference_ = 0;
  unsigned extremes_ = 0;
  SymbolModel multiple_{512}, first_{3};
  IntegerModel numbers_{32, 6};
};

/// RGB12 of LASzip 1.
class ColourOld {
 public:
  explicit ColourOld(const std::byte* first) { std::memcpy(last_.data(), first, 6); }
  void code(Decoder& coder, std::byte* item);

 private:
  std::array<std::uint8_t, 6> last_;
  SymbolModel used_{64};
  IntegerModel bytes_{8, 6};
};

/// One extra byte of LASzip 1.
class ExtraByteOld {
 public:
  explicit ExtraByteOld(const std::byte* first) : last_(std::to_integer<int>(*first)) {}
  void code(Decoder& coder, IntegerModel& shared, unsigned context, std::byte* item);

 private:
  int last_;
};

}  // namespace pcednet::io::laz
