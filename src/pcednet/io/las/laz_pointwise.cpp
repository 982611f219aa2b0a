#include <algorithm>
#include <deque>
#include <functional>
#include <memory>

#include "pcednet/core/bytes.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_items.h"

namespace pcednet::io::laz {
namespace {

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

std::int32_t median(const std::array<std::int32_t, 3>& v) {
  return std::max(std::min(v[0], v[1]), std::min(std::max(v[0], v[1]), v[2]));
}

Point10Old::Point10Old(const std::byte* first) {
  std::memcpy(last_.data(), first, last_.size());
}

void Point10Old::code(Decoder& coder, std::byte* item) {
  std::byte* last = last_.data();
  const auto move = [&](IntegerModel& model, unsigned context, std::size_t axis) {
    const std::int32_t difference = model.code(coder, median(diffs_[axis]), context);
    diffs_[axis][turn_] = difference;
    store(last + 4 * axis,
          load<std::uint32_t>(last + 4 * axis) + static_cast<std::uint32_t>(difference));
  };
  move(dx_, 0, 0);
  move(dy_, std::min(dx_.last_bits(), 19U), 1);
  turn_ = (turn_ + 1) % 3;
  const unsigned bits = (dx_.last_bits() + dy_.last_bits()) / 2;
  store(last + 8, z_.code(coder, load<std::int32_t>(last + 8), std::min(bits, 19U)));
  const unsigned changed = coder.symbol(changed_);
  const auto code_symbol = [&](unsigned flag, LazyModels& models, std::size_t at) {
    if (changed & flag) {
      last[at] = std::byte(coder.symbol(models[std::to_integer<std::size_t>(last[at])]));
    }
  };
  const auto code_word = [&](unsigned flag, IntegerModel& model, std::size_t at) {
    if (!(changed & flag)) return;
    store(last + at,
          static_cast<std::uint16_t>(model.code(coder, load<std::uint16_t>(last + at), 0)));
  };
  code_word(32, intensity_, 12);
  code_symbol(16, flags_, 14);
  code_symbol(8, classification_, 15);
  if (changed & 4) {
    const int angle = std::to_integer<int>(last[16]);
    last[16] = std::byte(scan_angle_.code(coder, angle, bits < 3 ? 1 : 0));
  }
  code_symbol(2, user_data_, 17);
  code_word(1, source_, 18);
  std::memcpy(item, last, last_.size());
}

void GpsTimeOld::code(Decoder& coder, std::byte* item) {
  const auto read_full = [&] {
    const std::uint32_t low = coder.word();
    last_ = static_cast<std::int64_t>(std::uint64_t{coder.word()} << 32 | low);
  };
  const auto move = [&](std::int32_t difference) {
    last_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(last_) +
                                      static_cast<std::uint64_t>(std::int64_t{difference}));
  };
  const auto near = [&](unsigned factor, unsigned context) {
    const auto predicted =
        static_cast<std::int32_t>(factor * static_cast<std::uint32_t>(difference_));
    return numbers_.code(coder, predicted, context);
  };
  if (difference_ == 0) {
    const unsigned symbol = coder.symbol(first_);
    if (symbol == 1) move(difference_ = numbers_.code(coder, 0, 0));
    if (symbol == 2) read_full();
  } else {
    const unsigned multiple = coder.symbol(multiple_);
    const auto count_extreme = [&](std::int32_t difference) {
      if (++extremes_ <= 3) return;
      difference_ = difference;
      extremes_ = 0;
    };
    if (multiple == 1) {
      difference_ = near(1, 1);
      move(difference_);
      extremes_ = 0;
    } else if (multiple == 0) {
      const std::int32_t difference = numbers_.code(coder, difference_ / 4, 2);
      move(difference);
      count_extreme(difference);
    } else if (multiple < 510) {
      const std::int32_t difference = near(multiple, multiple < 10 ? 3 : multiple < 50 ? 4 : 5);
      move(difference);
      if (multiple == 509) count_extreme(difference);
    } else if (multiple == 510) {
      read_full();
    }
  }
  store(item, last_);
}

void ColourOld::code(Decoder& coder, std::byte* item) {
  const unsigned used = coder.symbol(used_);
  for (unsigned b = 0; b < 6; ++b) {
    if (used >> b & 1) last_[b] = static_cast<std::uint8_t>(bytes_.code(coder, last_[b], b));
  }
  std::memcpy(item, last_.data(), last_.size());
}

void ExtraByteOld::code(Decoder& coder, IntegerModel& shared, unsigned context, std::byte* item) {
  last_ = shared.code(coder, last_, context);
  *item = std::byte(last_);
}

/// The models of a chunk's items; `step` codes one item of a record.
template <typename Coder>
using Step = std::function<void(Coder&, std::byte* record)>;

template <typename Model, typename Coder>
Step<Coder> step_of(std::shared_ptr<Model> model, std::size_t offset) {
  return [model = std::move(model), offset](Coder& coder, std::byte* record) {
    model->code(coder, record + offset);
  };
}

template <typename Coder>
Step<Coder> bytes_step(const std::byte* first, std::size_t offset, std::size_t count) {
  auto models = std::make_shared<std::deque<ExtraByte>>();
  for (std::size_t b = 0; b < count; ++b) models->emplace_back(first + b);
  return [models, offset](Coder& coder, std::byte* record) {
    std::size_t at = offset;
    for (ExtraByte& model : *models) model.code(coder, record + at++);
  };
}

Step<Decoder> old_step(const LazItem& item, const std::byte* first) {
  switch (item.type) {
    case kPoint10:
      return step_of<Point10Old, Decoder>(std::make_shared<Point10Old>(first), item.offset);
    case kGpsTime11:
      return step_of<GpsTimeOld, Decoder>(std::make_shared<GpsTimeOld>(load<std::int64_t>(first)),
                                          item.offset);
    case kRgb12:
      return step_of<ColourOld, Decoder>(std::make_shared<ColourOld>(first), item.offset);
    default: {
      auto shared = std::make_shared<IntegerModel>(8, static_cast<unsigned>(item.size));
      auto models = std::make_shared<std::vector<ExtraByteOld>>();
      for (std::size_t b = 0; b < item.size; ++b) models->emplace_back(first + b);
      return [=](Decoder& coder, std::byte* record) {
        for (unsigned b = 0; b < models->size(); ++b) {
          (*models)[b].code(coder, *shared, b, record + item.offset + b);
        }
      };
    }
  }
}

template <typename Coder>
Step<Coder> make_step(const LazItem& item, const std::byte* first) {
  if constexpr (!Coder::kEncodes) {
    if (item.version == 1 && item.type != kWave13) return old_step(item, first);
  }
  switch (item.type) {
    case kPoint10:
      return step_of<Point10, Coder>(std::make_shared<Point10>(first), item.offset);
    case kGpsTime11:
      return step_of<GpsTime, Coder>(std::make_shared<GpsTime>(load<std::int64_t>(first), true),
                                     item.offset);
    case kRgb12:
      return step_of<Colour, Coder>(std::make_shared<Colour>(first), item.offset);
    case kWave13:
      return step_of<WavePacket, Coder>(std::make_shared<WavePacket>(first), item.offset);
    default:
      return bytes_step<Coder>(first, item.offset, item.size);
  }
}

/// Codes all records but the first, which is stored verbatim.
template <typename Coder>
void code_records(Coder& coder, const std::vector<LazItem>& items, std::span<std::byte> rows,
                  std::size_t stride) {
  std::vector<Step<Coder>> steps;
  for (const LazItem& item : items) {
    steps.push_back(make_step<Coder>(item, rows.data() + item.offset));
  }
  for (std::size_t at = stride; at < rows.size(); at += stride) {
    for (const Step<Coder>& step : steps) step(coder, rows.data() + at);
  }
}

}  // namespace

std::string encode_pointwise(const std::vector<LazItem>& items, std::span<std::byte> rows,
                             std::size_t stride) {
  Encoder encoder;
  code_records(encoder, items, rows, stride);
  return std::string(reinterpret_cast<const char*>(rows.data()), stride) + encoder.finish();
}

bool decode_pointwise(const std::vector<LazItem>& items, std::span<const std::byte> bytes,
                      std::span<std::byte> rows, std::size_t stride) {
  if (bytes.size() < stride) return false;
  std::copy_n(bytes.begin(), stride, rows.begin());
  Decoder decoder;
  decoder.start(bytes.subspan(stride));
  code_records(decoder, items, rows, stride);
  return !decoder.overrun();
}

}  // namespace pcednet::io::laz
