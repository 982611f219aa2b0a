#include <algorithm>
#include <deque>
#include <functional>
#include <memory>

#include "pcednet/core/bytes.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/laz_items.h"
#include "pcednet/io/las/laz_items_old.h"

namespace pcednet::io::laz {
namespace {

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
