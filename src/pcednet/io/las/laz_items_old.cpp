#include "pcednet/io/las/laz_items_old.h"

#include <algorithm>

#include "pcednet/core/bytes.h"

namespace pcednet::io::laz {
namespace {

std::int32_t median(const std::array<std::int32_t, 3>& v) {
  return std::max(std::min(v[0], v[1]), std::min(std::max(v[0], v[1]), v[2]));
}

}  // namespace

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

}  // namespace pcednet::io::laz
