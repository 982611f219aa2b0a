#include "pcednet/io/las/laz_point14.h"

#include <algorithm>

#include "pcednet/core/bytes.h"

namespace pcednet::io::laz {
namespace {

enum LayerIndex : std::size_t {
  kXy,
  kZ,
  kClass,
  kFlags,
  kIntensity,
  kAngle,
  kUser,
  kSource,
  kTime
};

/// LASzip's contexts for a return (column) and number of returns (row).
constexpr std::uint8_t kReturnContext14[16][16] = {
    {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
    {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
    {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
    {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5}};

unsigned byte_of(const std::byte* at) {
  return std::to_integer<unsigned>(*at);
}

unsigned return_of(const std::byte* item) {
  return byte_of(item + 14) & 15;
}

unsigned returns_of(const std::byte* item) {
  return byte_of(item + 14) >> 4;
}

}  // namespace

struct Point14::Channel {
  explicit Channel(const std::byte* first) : time(load<std::int64_t>(first + 22), false) {
    std::memcpy(last.data(), first, last.size());
    height.fill(load<std::int32_t>(first + 8));
    intensity.fill(load<std::uint16_t>(first + 12));
  }

  std::array<std::byte, 30> last = {};
  bool time_changed = false;
  std::array<Median5, 12> x = {}, y = {};
  std::array<std::int32_t, 8> height = {}, intensity = {};
  LazyModels changed{8, 128}, returns{16, 16}, return_number{16, 16}, classification{64, 256};
  LazyModels flags{64, 64}, user_data{64, 256};
  SymbolModel scanner{3}, return_same_time{13};
  IntegerModel dx{32, 2}, dy{32, 22}, z{32, 20}, intensities{16, 4}, angle{16, 2}, source{16};
  GpsTime time;
};

Point14::Point14(const std::byte* first) : current_(channel_of(first)) {
  channels_[current_] = std::make_unique<Channel>(first);
}

Point14::~Point14() = default;

/// The changed fields, the scanner channel, number of returns and return number.
template <typename Coder>
Point14::Changes Point14::code_returns(Coder& coder, const std::byte* item) {
  Channel& from = *channels_[current_];
  const unsigned r_from = return_of(&from.last[0]), n_from = returns_of(&from.last[0]);
  const unsigned context =
      (r_from == 1 ? 1U : 0U) | (r_from >= n_from ? 2U : 0U) | (from.time_changed ? 4U : 0U);
  unsigned changed = 0;
  if constexpr (Coder::kEncodes) {
    const unsigned to = channel_of(item);
    const std::byte* last = channels_[to] ? &channels_[to]->last[0] : &from.last[0];
    const auto differs = [&](std::size_t at, std::size_t bytes) {
      return std::memcmp(item + at, last + at, bytes) != 0;
    };
    const unsigned step = (return_of(item) - return_of(last)) & 15;
    changed = (to != current_ ? 64U : 0U) | (differs(20, 2) ? 32U : 0U) |
              (differs(22, 8) ? 16U : 0U) | (differs(18, 2) ? 8U : 0U) |
              (returns_of(item) != returns_of(last) ? 4U : 0U) |
              (step == 0    ? 0U
               : step == 1  ? 1U
               : step == 15 ? 2U
                            : 3U);
  }
  changed = coder.symbol(from.changed[context], changed);
  if (changed & 64) {
    unsigned step = (channel_of(item) - current_ - 1) & 3;
    step = coder.symbol(from.scanner, step);
    current_ = (current_ + step + 1) & 3;
    if (!channels_[current_]) channels_[current_] = std::make_unique<Channel>(&from.last[0]);
  }
  Channel& channel = *channels_[current_];
  const Changes changes{(changed & 32) != 0, (changed & 16) != 0, (changed & 8) != 0};
  const unsigned n_last = returns_of(&channel.last[0]), r_last = return_of(&channel.last[0]);
  unsigned n = n_last, r = r_last;
  if (changed & 4) n = coder.symbol(channel.returns[n_last], returns_of(item));
  if ((changed & 3) == 1) r = (r_last + 1) & 15;
  if ((changed & 3) == 2) r = (r_last + 15) & 15;
  if ((changed & 3) == 3) {
    r = changes.time
            ? coder.symbol(channel.return_number[r_last], return_of(item))
            : (r_last + 2 +
               coder.symbol(channel.return_same_time, (return_of(item) - r_last - 2) & 15)) &
                  15;
  }
  channel.last[14] = std::byte(n << 4 | r);
  const unsigned flags = byte_of(&channel.last[15]) & 0xCFU;
  channel.last[15] = std::byte(flags | current_ << 4);
  return changes;
}

template <typename Coder>
void Point14::code_position(Coder& coder, Coder* z_coder, const std::byte* item,
                            bool time_changes) {
  Channel& channel = *channels_[current_];
  std::byte* last = channel.last.data();
  const unsigned n = returns_of(last), r = return_of(last), single = n == 1 ? 1 : 0;
  const std::size_t m = std::size_t{kReturnContext14[n][r]} << 1 | (time_changes ? 1U : 0U);
  const unsigned l = std::min(n > r ? n - r : r - n, 7U);
  code_axis(coder, channel.dx, channel.x[m], single, last, item);
  code_axis(coder, channel.dy, channel.y[m], single + even_bits(channel.dx.last_bits(), 20),
            last + 4, item + 4);
  if (z_coder == nullptr) return;
  const unsigned bits = (channel.dx.last_bits() + channel.dy.last_bits()) / 2;
  channel.height[l] = channel.z.code(*z_coder, channel.height[l], single + even_bits(bits, 18),
                                     load<std::int32_t>(item + 8));
  store(last + 8, channel.height[l]);
}

template <typename Coder>
void Point14::code_rest(const std::array<Coder*, 9>& coders, const std::byte* item,
                        const Changes& changes) {
  Channel& channel = *channels_[current_];
  std::byte* last = channel.last.data();
  const unsigned n = returns_of(last), r = return_of(last);
  const unsigned place = (r == 1 ? 2U : 0U) + (r >= n ? 1U : 0U);
  if (coders[kClass]) {
    const std::size_t context = (byte_of(last + 16) & 0x1FU) << 1 | (place == 3 ? 1U : 0U);
    last[16] =
        std::byte(coders[kClass]->symbol(channel.classification[context], byte_of(item + 16)));
  }
  if (coders[kFlags]) {
    // Edge of flight line, scan direction, four flags: the byte without the scanner channel.
    const auto pack = [](unsigned b) { return (b & 15U) | (b >> 2 & 0x30U); };
    const unsigned flags =
        coders[kFlags]->symbol(channel.flags[pack(byte_of(last + 15))], pack(byte_of(item + 15)));
    last[15] = std::byte((flags & 15U) | (flags & 0x30U) << 2 | current_ << 4);
  }
  if (coders[kIntensity]) {
    std::int32_t& intensity = channel.intensity[place << 1 | (changes.time ? 1U : 0U)];
    intensity = channel.intensities.code(*coders[kIntensity], intensity, place,
                                         load<std::uint16_t>(item + 12));
    store(last + 12, static_cast<std::uint16_t>(intensity));
  }
  if (coders[kAngle] && changes.angle) {
    store(last + 18, static_cast<std::int16_t>(
                         channel.angle.code(*coders[kAngle], load<std::int16_t>(last + 18),
                                            changes.time ? 1 : 0, load<std::int16_t>(item + 18))));
  }
  if (coders[kUser]) {
    last[17] = std::byte(
        coders[kUser]->symbol(channel.user_data[byte_of(last + 17) / 4], byte_of(item + 17)));
  }
  if (coders[kSource] && changes.source) {
    store(last + 20, static_cast<std::uint16_t>(
                         channel.source.code(*coders[kSource], load<std::uint16_t>(last + 20), 0,
                                             load<std::uint16_t>(item + 20))));
  }
  if (coders[kTime] && changes.time) {
    std::memcpy(last + 22, item + 22, 8);
    channel.time.code(*coders[kTime], last + 22);
  }
}

template <typename Coder>
unsigned Point14::code(const std::array<Coder*, 9>& coders, std::byte* item) {
  const Changes changes = code_returns(*coders[kXy], item);
  code_position(*coders[kXy], coders[kZ], item, changes.time);
  code_rest(coders, item, changes);
  channels_[current_]->time_changed = changes.time;
  std::memcpy(item, channels_[current_]->last.data(), 30);
  return current_;
}

template unsigned Point14::code(const std::array<Decoder*, 9>&, std::byte*);
template unsigned Point14::code(const std::array<Encoder*, 9>&, std::byte*);

}  // namespace pcednet::io::laz
