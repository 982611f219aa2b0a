#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "pcednet/core/bytes.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_items.h"
#include "pcednet/io/las/laz_point14.h"

namespace pcednet::io::laz {
namespace {

constexpr std::size_t kPointLayers = 9;

/// One layer with models of its own for each of four contexts.
template <typename Coder>
class ContextItem {
 public:
  virtual ~ContextItem() = default;
  virtual void code(Coder* coder, unsigned context, std::byte* item) = 0;
};

/// Until version 4 LASzip predicts the first value after a return to a context from the value
/// before it, of the other context, and keeps it there.
template <typename Model, typename Coder>
class ContextModels : public ContextItem<Coder> {
 public:
  ContextModels(const std::byte* first, unsigned context, bool follows)
      : follows_(follows), context_(context) {
    models_[context].emplace(first);
  }

  void code(Coder* coder, unsigned context, std::byte* item) override {
    auto* last = &models_[context_]->last;
    if (context != context_) {
      context_ = context;
      const bool is_new = !models_[context];
      if (is_new) models_[context].emplace(reinterpret_cast<const std::byte*>(last));
      if (is_new || follows_) last = &models_[context]->last;
    }
    if (coder == nullptr) {
      std::memcpy(item, last, sizeof *last);
      return;
    }
    Model& model = *models_[context];
    const auto own = model.last;
    model.last = *last;
    model.code(*coder, item);
    if (&model.last == last) return;
    *last = model.last;
    model.last = own;
  }

 private:
  bool follows_;
  unsigned context_;
  std::array<std::optional<Model>, 4> models_ = {};
};

/// A layer's place in the record.
template <typename Coder>
struct Layer {
  std::unique_ptr<ContextItem<Coder>> item;
  std::size_t offset = 0, bytes = 0;
};

template <typename Coder>
std::vector<Layer<Coder>> layers_of(const std::vector<LazItem>& items, const std::byte* first) {
  std::vector<Layer<Coder>> layers;
  const unsigned context = channel_of(first);
  for (const LazItem& item : items) {
    const bool follows = item.version > 3;
    const auto add = [&](auto* type, std::size_t at, std::size_t bytes) {
      using Model = std::remove_pointer_t<decltype(type)>;
      layers.push_back(
          {std::make_unique<ContextModels<Model, Coder>>(first + at, context, follows), at, bytes});
    };
    const std::size_t at = item.offset;
    if (item.type == kRgb14 || item.type == kRgbNir14) add(static_cast<Colour*>(nullptr), at, 6);
    if (item.type == kRgbNir14) add(static_cast<Infrared*>(nullptr), at + 6, 2);
    if (item.type == kWave14) add(static_cast<WavePacket*>(nullptr), at, 29);
    if (item.type != kByte14) continue;
    for (std::size_t b = 0; b < item.size; ++b) add(static_cast<ExtraByte*>(nullptr), at + b, 1);
  }
  return layers;
}

template <typename Coder>
void code_records(const std::vector<LazItem>& items, std::deque<Coder>& coders,
                  const std::vector<bool>& present, std::span<std::byte> rows, std::size_t stride) {
  std::array<Coder*, kPointLayers> point_coders = {};
  for (std::size_t layer = 0; layer < kPointLayers; ++layer) {
    point_coders[layer] = present[layer] ? &coders[layer] : nullptr;
  }
  Point14 points(rows.data());
  const auto layers = layers_of<Coder>(items, rows.data());
  // The scanner channel is the context of the other items. Until version 4 LASzip codes it for them
  // only where it changes: context 0 then means a point that stays in its channel, whichever that
  // is.
  const bool always_told = items[0].version > 3;
  unsigned before = channel_of(rows.data());
  for (std::size_t at = stride; at < rows.size(); at += stride) {
    std::byte* record = rows.data() + at;
    const unsigned channel = points.code(point_coders, record);
    const unsigned context = always_told || channel != before ? channel : 0;
    before = channel;
    for (std::size_t l = 0; l < layers.size(); ++l) {
      Coder* coder = present[kPointLayers + l] ? &coders[kPointLayers + l] : nullptr;
      layers[l].item->code(coder, context, record + layers[l].offset);
    }
  }
}

/// The layers whose bytes of the record change: constant ones are left out.
std::vector<bool> changing_layers(const std::vector<LazItem>& items, std::span<std::byte> rows,
                                  std::size_t stride) {
  const auto changes = [&](std::size_t offset, std::size_t bytes, std::byte mask) {
    for (std::size_t at = stride; at < rows.size(); at += stride) {
      for (std::size_t b = offset; b < offset + bytes; ++b) {
        if (((rows[at + b] ^ rows[b]) & mask) != std::byte{0}) return true;
      }
    }
    return false;
  };
  constexpr std::byte kAll{0xFF};
  std::vector<bool> present = {true,
                               changes(8, 4, kAll),
                               changes(16, 1, kAll),
                               changes(15, 1, std::byte{0xCF}),
                               changes(12, 2, kAll),
                               changes(18, 2, kAll),
                               changes(17, 1, kAll),
                               changes(20, 2, kAll),
                               changes(22, 8, kAll)};
  for (const auto& layer : layers_of<Encoder>(items, rows.data())) {
    present.push_back(changes(layer.offset, layer.bytes, kAll));
  }
  return present;
}

}  // namespace

std::size_t layer_count(const std::vector<LazItem>& items) {
  std::size_t count = kPointLayers;
  for (const LazItem& item : items) {
    if (item.type == kRgb14 || item.type == kWave14) count += 1;
    if (item.type == kRgbNir14) count += 2;
    if (item.type == kByte14) count += item.size;
  }
  return count;
}

std::string encode_layered(const std::vector<LazItem>& items, std::span<std::byte> rows,
                           std::size_t stride) {
  const std::vector<bool> present = changing_layers(items, rows, stride);
  std::deque<Encoder> coders(present.size());
  code_records(items, coders, present, rows, stride);
  std::string bytes(reinterpret_cast<const char*>(rows.data()), stride), data;
  const auto append = [&bytes](std::size_t number) {
    const auto word = static_cast<std::uint32_t>(number);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  append(rows.size() / stride);
  for (std::size_t l = 0; l < present.size(); ++l) {
    const std::string layer = present[l] ? coders[l].finish() : std::string();
    append(layer.size());
    data += layer;
  }
  return bytes + data;
}

bool decode_layered(const std::vector<LazItem>& items, std::span<const std::byte> bytes,
                    std::span<std::byte> rows, std::size_t stride) {
  if (bytes.size() < stride) return false;
  std::copy_n(bytes.begin(), stride, rows.begin());
  const std::size_t count = layer_count(items);
  std::size_t at = stride + 4, data = at + 4 * count;
  if (bytes.size() < data || load<std::uint32_t>(&bytes[stride]) < rows.size() / stride) {
    return false;
  }
  std::deque<Decoder> coders(count);
  std::vector<bool> present(count);
  for (std::size_t l = 0; l < count; ++l, at += 4) {
    const std::size_t size = load<std::uint32_t>(&bytes[at]);
    if (size > bytes.size() - data) return false;
    present[l] = size > 0;
    if (size > 0) coders[l].start(bytes.subspan(data, size));
    data += size;
  }
  if (!present[0] && rows.size() > stride) return false;
  code_records(items, coders, present, rows, stride);
  return std::none_of(coders.begin(), coders.end(), [](const Decoder& d) { return d.overrun(); });
}

}  // namespace pcednet::io::laz
