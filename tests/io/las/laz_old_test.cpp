#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/las/las_writer.h"
#include "pcednet/io/las/laz_items.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kExtra = 2;

/// Encodes points of format 3 as the first version of LASzip did. Its models are those that the
/// specification gives each item; the coder is ours.
class OldEncoder {
 public:
  explicit OldEncoder(const std::string& first) : last_(first) {}

  void add(const std::string& row) {
    add_point(row);
    add_time(get_number<std::int64_t>(row, 20) - get_number<std::int64_t>(last_, 20),
             get_number<std::uint64_t>(row, 20));
    add_bytes(row);
    last_ = row;
  }

  std::string finish() { return coder_.finish(); }

 private:
  static unsigned byte_of(const std::string& row, std::size_t at) {
    return static_cast<std::uint8_t>(row[at]);
  }

  static std::int32_t median(std::array<std::int32_t, 3> values) {
    std::sort(values.begin(), values.end());
    return values[1];
  }

  void add_point(const std::string& row) {
    const auto difference = [&](std::size_t at) {
      return static_cast<std::int32_t>(get_number<std::uint32_t>(row, at) -
                                       get_number<std::uint32_t>(last_, at));
    };
    const std::int32_t dx = difference(0), dy = difference(4);
    x_.code(coder_, median(before_x_), 0, dx);
    y_.code(coder_, median(before_y_), std::min(x_.last_bits(), 19U), dy);
    before_x_[turn_] = dx;
    before_y_[turn_] = dy;
    turn_ = (turn_ + 1) % 3;
    const unsigned bits = (x_.last_bits() + y_.last_bits()) / 2;
    z_.code(coder_, get_number<std::int32_t>(last_, 8), std::min(bits, 19U),
            get_number<std::int32_t>(row, 8));
    const auto differs = [&](std::size_t at, std::size_t bytes) {
      return row.compare(at, bytes, last_, at, bytes) != 0 ? 1U : 0U;
    };
    const unsigned changed = differs(12, 2) << 5 | differs(14, 1) << 4 | differs(15, 1) << 3 |
                             differs(16, 1) << 2 | differs(17, 1) << 1 | differs(18, 2);
    coder_.symbol(changed_, changed);
    const auto add_word = [&](laz::IntegerModel& model, std::size_t at) {
      model.code(coder_, get_number<std::uint16_t>(last_, at), 0,
                 get_number<std::uint16_t>(row, at));
    };
    const auto add_symbol = [&](laz::LazyModels& models, std::size_t at) {
      coder_.symbol(models[byte_of(last_, at)], byte_of(row, at));
    };
    if (changed & 32) add_word(intensity_, 12);
    if (changed & 16) add_symbol(flags_, 14);
    if (changed & 8) add_symbol(classification_, 15);
    if (changed & 4) {
      angle_.code(coder_, static_cast<int>(byte_of(last_, 16)), bits < 3 ? 1 : 0,
                  static_cast<int>(byte_of(row, 16)));
    }
    if (changed & 2) add_symbol(user_, 17);
    if (changed & 1) add_word(source_, 18);
  }

  void add_time(std::int64_t away, std::uint64_t time) {
    const auto near = static_cast<std::int32_t>(away);
    const auto add_full = [&](laz::SymbolModel& model, unsigned symbol) {
      coder_.symbol(model, symbol);
      coder_.word(static_cast<std::uint32_t>(time));
      coder_.word(static_cast<std::uint32_t>(time >> 32));
    };
    if (step_ == 0) {
      if (near != away) return add_full(zero_step_, 2);
      coder_.symbol(zero_step_, away == 0 ? 0 : 1);
      if (away == 0) return;
      times_.code(coder_, 0, 0, near);
      step_ = near;
      return;
    }
    if (near != away) return add_full(multiple_, 510);
    if (away == 0) {
      coder_.symbol(multiple_, 511);
      return;
    }
    const double ratio = static_cast<double>(near) / step_;
    const auto factor = static_cast<unsigned>(std::lround(std::clamp(ratio, 0.0, 509.0)));
    coder_.symbol(multiple_, factor);
    const std::int32_t predicted =
        factor == 0 ? step_ / 4
                    : static_cast<std::int32_t>(factor * static_cast<std::uint32_t>(step_));
    const unsigned context = factor == 0   ? 2
                             : factor == 1 ? 1
                             : factor < 10 ? 3
                             : factor < 50 ? 4
                                           : 5;
    times_.code(coder_, predicted, context, near);
    if (factor == 1) {
      step_ = near;
      extremes_ = 0;
    } else if ((factor == 0 || factor == 509) && ++extremes_ > 3) {
      step_ = near;
      extremes_ = 0;
    }
  }

  /// The six bytes of the colours, those that change; all extra bytes.
  void add_bytes(const std::string& row) {
    unsigned used = 0;
    for (std::size_t b = 0; b < 6; ++b) used |= (row[28 + b] != last_[28 + b] ? 1U : 0U) << b;
    coder_.symbol(used_, used);
    const auto add_byte = [&](laz::IntegerModel& model, unsigned context, std::size_t at) {
      model.code(coder_, static_cast<int>(byte_of(last_, at)), context,
                 static_cast<int>(byte_of(row, at)));
    };
    for (unsigned b = 0; b < 6; ++b) {
      if (used >> b & 1) add_byte(colours_, b, 28 + b);
    }
    for (unsigned b = 0; b < kExtra; ++b) add_byte(extra_, b, 34 + b);
  }

  std::string last_;
  laz::Encoder coder_ = {};
  std::array<std::int32_t, 3> before_x_ = {}, before_y_ = {};
  std::size_t turn_ = 0;
  std::int32_t step_ = 0;
  unsigned extremes_ = 0;
  laz::SymbolModel changed_{64}, multiple_{512}, zero_step_{3}, used_{64};
  laz::LazyModels flags_{256, 256}, classification_{256, 256}, user_{256, 256};
  laz::IntegerModel x_{32}, y_{32, 20}, z_{32, 20}, intensity_{16}, angle_{8, 2}, source_{16};
  laz::IntegerModel times_{32, 6}, colours_{8, 6}, extra_{8, kExtra};
};

/// The file compressed as one piece, without a chunk table.
std::string old_laz_bytes(LasTestFile file) {
  const auto items = packed(std::uint16_t{4}) +
                     packed(std::uint16_t{6}, std::uint16_t{20}, std::uint16_t{1}) +
                     packed(std::uint16_t{7}, std::uint16_t{8}, std::uint16_t{1}) +
                     packed(std::uint16_t{8}, std::uint16_t{6}, std::uint16_t{1}) +
                     packed(std::uint16_t{0}, std::uint16_t{kExtra}, std::uint16_t{1});
  file.records.push_back(
      {"laszip encoded", 22204,
       packed(std::uint16_t{1}, std::uint16_t{0}, std::uint8_t{1}, std::uint8_t{2},
              std::uint16_t{0}, 0U, UINT32_MAX, std::int64_t{-1}, std::int64_t{-1}) +
           items});
  std::string whole = las_bytes(file);
  whole.resize(get_number<std::uint32_t>(whole, 96));
  whole[104] = static_cast<char>(file.format | 128U);
  const std::size_t stride = las_test_stride(file.format, file.extra);
  OldEncoder encoder(file.rows.substr(0, stride));
  for (std::size_t at = stride; at < file.rows.size(); at += stride) {
    encoder.add(file.rows.substr(at, stride));
  }
  return whole + file.rows.substr(0, stride) + encoder.finish();
}

void expect_same_points(const PointCloud& a, const PointCloud& b) {
  EXPECT_TRUE(same_bits(a.positions, b.positions));
  ASSERT_EQ(a.attributes.size(), b.attributes.size());
  for (std::size_t i = 0; i < a.attributes.size(); ++i) {
    EXPECT_TRUE(same_bits(a.attributes[i].bytes, b.attributes[i].bytes)) << a.attributes[i].name;
  }
}

TEST(LazOld, ReadsTheFirstVersionOfEveryItem) {
  const Scratch scratch;
  for (const std::size_t points : {1, 2, 5000}) {
    const LasTestFile file{3, 2, las_test_rows(3, points, kExtra), kExtra};
    expect_same_points(scratch.read("a.laz", old_laz_bytes(file)).cloud,
                       scratch.read("a.las", las_bytes(file)).cloud);
  }
}

}  // namespace
}  // namespace pcednet::io
