// Which of its four contexts LASzip codes an item with, written down a second time, from the
// program's own steps: a cursor that moves from context to context, and one last item in each.
#include <gtest/gtest.h>

#include <optional>

#include "io/las/las_writer.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_items.h"

namespace pcednet::io {
namespace {

unsigned channel_at(std::string_view rows, std::size_t stride, std::size_t point) {
  return static_cast<std::uint8_t>(rows[point * stride + 15]) >> 4U & 3U;
}

/// What POINT14 tells the other items: from version 4 on always its channel; before, only where
/// that changes, and 0 where it does not.
std::vector<unsigned> contexts_of(std::string_view rows, std::size_t stride, unsigned version) {
  std::vector<unsigned> contexts = {channel_at(rows, stride, 0)};
  for (std::size_t i = 1; i < rows.size() / stride; ++i) {
    const unsigned channel = channel_at(rows, stride, i);
    const bool told = version >= 4 || channel != channel_at(rows, stride, i - 1);
    contexts.push_back(told ? channel : 0);
  }
  return contexts;
}

struct Part {
  std::size_t offset = 0, bytes = 0;
};

/// The values of one layer, each with the one it is predicted from, and by which context's model.
struct Step {
  unsigned context = 0;
  std::string value, last;
};

std::vector<Step> steps_of(std::string_view rows, std::size_t stride, const Part& part,
                           unsigned version) {
  const std::vector<unsigned> contexts = contexts_of(rows, stride, version);
  const auto value_at = [&](std::size_t point) {
    return std::string(rows.substr(point * stride + part.offset, part.bytes));
  };
  std::array<std::optional<std::string>, 4> last_items;
  unsigned current = contexts[0];
  last_items[current] = value_at(0);
  std::vector<Step> steps;
  for (std::size_t i = 1; i < contexts.size(); ++i) {
    unsigned from = current;
    if (contexts[i] != current) {
      current = contexts[i];
      if (!last_items[current]) {
        last_items[current] = last_items[from];
        from = current;
      } else if (version >= 4) {
        from = current;
      }
    }
    steps.push_back({current, value_at(i), *last_items[from]});
    last_items[from] = value_at(i);
  }
  return steps;
}

bool changes(const std::vector<Step>& steps) {
  return std::any_of(steps.begin(), steps.end(),
                     [&](const Step& s) { return s.value != steps[0].last; });
}

/// A layer of bytes, of which LASzip codes the difference to the last.
std::string byte_layer(const std::vector<Step>& steps) {
  laz::LazyModels models(4, 256);
  laz::Encoder encoder;
  for (const Step& step : steps) {
    const auto difference = static_cast<std::uint8_t>(step.value[0] - step.last[0]);
    encoder.symbol(models[step.context], difference);
  }
  return changes(steps) ? encoder.finish() : "";
}

template <typename Model>
std::string layer(const std::vector<Step>& steps) {
  std::array<std::optional<Model>, 4> models;
  laz::Encoder encoder;
  for (const Step& step : steps) {
    std::string value = step.value;
    auto& model = models[step.context];
    if (!model) model.emplace(reinterpret_cast<const std::byte*>(step.last.data()));
    std::memcpy(&model->last, step.last.data(), step.last.size());
    model->code(encoder, reinterpret_cast<std::byte*>(value.data()));
  }
  return changes(steps) ? encoder.finish() : "";
}

std::vector<LazItem> items_of(unsigned format, std::size_t extra, unsigned version) {
  std::vector<LazItem> items = {{10, 30, version, 0}};
  const auto add = [&](unsigned type, std::size_t size) {
    items.push_back({type, size, version, items.back().offset + items.back().size});
  };
  if (format == 7) add(11, 6);
  if (format == 8 || format == 10) add(12, 8);
  if (format > 8) add(13, 29);
  if (extra > 0) add(14, extra);
  return items;
}

/// The layers behind the nine of POINT14.
std::vector<std::string> layers_of(const std::vector<LazItem>& items, std::string_view rows,
                                   std::size_t stride) {
  std::vector<std::string> layers;
  for (const LazItem& item : items) {
    const auto steps = [&](std::size_t first, std::size_t bytes) {
      return steps_of(rows, stride, {item.offset + first, bytes}, item.version);
    };
    if (item.type == 11 || item.type == 12) layers.push_back(layer<laz::Colour>(steps(0, 6)));
    if (item.type == 12) layers.push_back(layer<laz::Infrared>(steps(6, 2)));
    if (item.type == 13) layers.push_back(layer<laz::WavePacket>(steps(0, 29)));
    if (item.type != 14) continue;
    for (std::size_t b = 0; b < item.size; ++b) layers.push_back(byte_layer(steps(b, 1)));
  }
  return layers;
}

/// The layers of a chunk.
std::vector<std::string> split(const std::string& chunk, std::size_t stride, std::size_t count) {
  std::vector<std::string> layers;
  std::size_t at = stride + 4 + 4 * count;
  for (std::size_t l = 0; l < count; ++l) {
    const auto size = get_number<std::uint32_t>(chunk, stride + 4 + 4 * l);
    layers.push_back(chunk.substr(at, size));
    at += size;
  }
  EXPECT_EQ(at, chunk.size());
  return layers;
}

/// Expects of both directions that they choose contexts as above.
void expect_contexts(unsigned format, unsigned version, const std::string& rows,
                     std::size_t extra) {
  const std::size_t stride = las_test_stride(format, extra);
  const auto items = items_of(format, extra, version);
  const auto wanted = layers_of(items, rows, stride);
  std::string copy = rows;
  const std::string chunk =
      laz::encode_layered(items, std::as_writable_bytes(std::span(copy)), stride);
  const auto layers = split(chunk, stride, 9 + wanted.size());
  for (std::size_t l = 0; l < wanted.size(); ++l) {
    EXPECT_TRUE(layers[9 + l] == wanted[l])
        << "format " << format << ", version " << version << ", layer " << l;
  }
  std::string decoded(rows.size(), '\0');
  EXPECT_TRUE(laz::decode_layered(items, std::as_bytes(std::span(chunk)),
                                  std::as_writable_bytes(std::span(decoded)), stride));
  EXPECT_TRUE(decoded == rows) << "format " << format << ", version " << version;
}

TEST(LazContext, FollowsLaszipWhenTheScannerChannelVaries) {
  for (unsigned format = 6; format <= 10; ++format) {
    for (const unsigned version : {2U, 3U, 4U}) {
      for (unsigned channels = 1; channels <= 4; ++channels) {
        expect_contexts(format, version, las_test_rows(format, 400, 3, channels, channels), 3);
      }
    }
  }
}

TEST(LazContext, FollowsLaszipWhereAllPointsAreOfOneChannelThatIsNotTheFirst) {
  for (unsigned format = 6; format <= 10; ++format) {
    std::string rows = las_test_rows(format, 400, 2);
    const std::size_t stride = las_test_stride(format, 2);
    for (std::size_t at = 15; at < rows.size(); at += stride)
      rows[at] = static_cast<char>(rows[at] | 0x30);
    for (const unsigned version : {3U, 4U}) expect_contexts(format, version, rows, 2);
  }
}

}  // namespace
}  // namespace pcednet::io
