#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pcednet/io/las/file.h"

namespace pcednet::io {
namespace {

/// Collects fields that lie one after the other.
class FieldList {
 public:
  void add(std::string name, ScalarType type) {
    fields_.push_back({std::move(name), type, offset_});
    offset_ += size_of(type);
  }
  /// The next bits of the byte at hand.
  void add_bits(std::string name, unsigned bits) {
    fields_.push_back({std::move(name), ScalarType::kUint8, offset_, 1, shift_, bits});
    shift_ += bits;
    if (shift_ < 8) return;
    shift_ = 0;
    ++offset_;
  }
  std::size_t bytes() const { return offset_; }
  std::vector<LasField> take() { return std::move(fields_); }

 private:
  std::vector<LasField> fields_;
  std::size_t offset_ = 0;
  unsigned shift_ = 0;
};

void add_bits_of_old_formats(FieldList& list) {
  list.add_bits("ReturnNumber", 3);
  list.add_bits("NumberOfReturns", 3);
  list.add_bits("ScanDirectionFlag", 1);
  list.add_bits("EdgeOfFlightLine", 1);
  list.add_bits("Classification", 5);
  list.add_bits("Synthetic", 1);
  list.add_bits("KeyPoint", 1);
  list.add_bits("Withheld", 1);
  list.add("ScanAngleRank", ScalarType::kInt8);
  list.add("UserData", ScalarType::kUint8);
  list.add("PointSourceId", ScalarType::kUint16);
}

void add_bits_of_new_formats(FieldList& list) {
  list.add_bits("ReturnNumber", 4);
  list.add_bits("NumberOfReturns", 4);
  list.add_bits("Synthetic", 1);
  list.add_bits("KeyPoint", 1);
  list.add_bits("Withheld", 1);
  list.add_bits("Overlap", 1);
  list.add_bits("ScanChannel", 2);
  list.add_bits("ScanDirectionFlag", 1);
  list.add_bits("EdgeOfFlightLine", 1);
  list.add("Classification", ScalarType::kUint8);
  list.add("UserData", ScalarType::kUint8);
  list.add("ScanAngle", ScalarType::kInt16);
  list.add("PointSourceId", ScalarType::kUint16);
}

void add_wave_packet(FieldList& list) {
  list.add("WavePacketDescriptorIndex", ScalarType::kUint8);
  list.add("WaveformDataOffset", ScalarType::kUint64);
  list.add("WaveformPacketSize", ScalarType::kUint32);
  list.add("ReturnPointWaveformLocation", ScalarType::kFloat32);
  for (const char* name : {"Xt", "Yt", "Zt"}) list.add(name, ScalarType::kFloat32);
}

FieldList list_fields(unsigned format) {
  const auto is_one_of = [format](std::initializer_list<unsigned> formats) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  };
  FieldList list;
  for (const char* axis : {"X", "Y", "Z"}) list.add(axis, ScalarType::kInt32);
  list.add("Intensity", ScalarType::kUint16);
  if (format < 6) {
    add_bits_of_old_formats(list);
  } else {
    add_bits_of_new_formats(list);
  }
  if (!is_one_of({0, 2})) list.add("GpsTime", ScalarType::kFloat64);
  if (is_one_of({2, 3, 5, 7, 8, 10})) {
    for (const char* name : kLasChannels) list.add(name, ScalarType::kUint16);
  }
  if (is_one_of({8, 10})) list.add("Infrared", ScalarType::kUint16);
  if (is_one_of({4, 5, 9, 10})) add_wave_packet(list);
  return list;
}

/// The types of the standard's list, from 1 on.
constexpr std::array kExtraTypes = {ScalarType::kUint8,  ScalarType::kInt8,   ScalarType::kUint16,
                                    ScalarType::kInt16,  ScalarType::kUint32, ScalarType::kInt32,
                                    ScalarType::kUint64, ScalarType::kInt64,  ScalarType::kFloat32,
                                    ScalarType::kFloat64};

const char* const kOurs[] = {"edge_class", "p_sharp", "p_smooth"};

std::string to_attribute_name(const std::string& name) {
  const bool ours = std::find(std::begin(kOurs), std::end(kOurs), name) != std::end(kOurs);
  return ours ? "scalar_" + name : name;
}

std::string to_file_name(const std::string& name) {
  for (const char* ours : kOurs) {
    if (name == fmt::format("scalar_{}", ours)) return ours;
  }
  return name;
}

LasField read_descriptor(std::string_view bytes) {
  const unsigned type = number_at<std::uint8_t>(bytes, las_descriptor::kType);
  const std::string_view name = bytes.substr(las_descriptor::kName, las_descriptor::kNameBytes);
  LasField field{to_attribute_name(until_zero(name))};
  if (type == 0 || type > 3 * kExtraTypes.size()) {
    field.components = number_at<std::uint8_t>(bytes, las_descriptor::kOptions);
  } else {
    field.type = kExtraTypes[(type - 1) % kExtraTypes.size()];
    field.components = 1 + (type - 1) / kExtraTypes.size();
  }
  return field;
}

}  // namespace

std::size_t las_format_bytes(unsigned format) {
  return list_fields(format).bytes();
}

std::vector<LasField> las_standard_fields(unsigned format) {
  return list_fields(format).take();
}

bool las_format_has(unsigned format, std::string_view field) {
  return std::ranges::count(las_standard_fields(format), field, &LasField::name) > 0;
}

std::vector<LasField> las_extra_fields(const LasFile& file, std::vector<std::string>& warnings) {
  std::set<std::string> taken;
  for (const LasField& field : las_standard_fields(file.point_format())) taken.insert(field.name);
  std::vector<LasField> fields;
  std::size_t offset = las_format_bytes(file.point_format());
  const std::size_t end = file.record_length();
  const auto add = [&](LasField field) {
    if (field.name.empty()) field.name = "ExtraBytes";
    while (!taken.insert(field.name).second) field.name += '_';
    field.offset = offset;
    offset += field.components * size_of(field.type);
    fields.push_back(std::move(field));
  };
  const LasRecord* const record = find_record(file.records, kExtraBytesRecord);
  const std::string_view descriptors = record ? std::string_view(record->data) : "";
  for (std::size_t at = 0; at + las_descriptor::kBytes <= descriptors.size();
       at += las_descriptor::kBytes) {
    LasField field = read_descriptor(descriptors.substr(at, las_descriptor::kBytes));
    if (field.components == 0) continue;
    if (offset + field.components * size_of(field.type) > end) {
      warnings.push_back(fmt::format(
          "extra bytes \"{}\" are described but not in the points' {} bytes", field.name, end));
      break;
    }
    field.descriptor = at;
    add(std::move(field));
  }
  if (offset < end) add({"ExtraBytes", ScalarType::kUint8, 0, end - offset});
  return fields;
}

std::string las_extra_descriptor(const LasField& field) {
  std::string bytes(las_descriptor::kBytes, '\0');
  const auto place = std::find(kExtraTypes.begin(), kExtraTypes.end(), field.type);
  const auto type = static_cast<std::uint8_t>(1 + (place - kExtraTypes.begin()));
  const bool plain = field.components == 1;
  put_number<std::uint8_t>(bytes, las_descriptor::kType, plain ? type : 0);
  put_number<std::uint8_t>(
      bytes, las_descriptor::kOptions,
      plain ? 0 : static_cast<std::uint8_t>(field.components * size_of(field.type)));
  to_file_name(field.name).copy(&bytes[las_descriptor::kName], las_descriptor::kNameBytes);
  if (field.name == "scalar_edge_class") {
    std::string("1 smooth 2 sharp 3 boundary")
        .copy(&bytes[las_descriptor::kDescription], las_descriptor::kDescriptionBytes);
  }
  return bytes;
}

}  // namespace pcednet::io
