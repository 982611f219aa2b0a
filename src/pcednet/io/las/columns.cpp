#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "pcednet/core/bytes.h"
#include "pcednet/core/error.h"
#include "pcednet/io/las/extra_names.h"
#include "pcednet/io/las/layout.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// The descriptors of extra bytes, whole ones.
std::string descriptors_of(const LasFile& file) {
  const LasRecord* const record = find_record(file.records, kExtraBytesRecord);
  if (!record) return {};
  return record->data.substr(0,
                             record->data.size() / las_descriptor::kBytes * las_descriptor::kBytes);
}

/// Builds the columns: those of the file's own fields first, then extra bytes for what is left.
class LayoutBuilder {
 public:
  LayoutBuilder(const PointCloud& part, const WriteOptions& options, const LasChoices& choices)
      : cloud_(part),
        options_(options),
        choices_(choices),
        file_(layout_.file),
        keep_stored_(!part.has_normals() || !options.new_normals || normals_are_stored(part)) {
    file_ = choices.file;
    for (const Attribute& attribute : part.attributes) {
      by_name_[attribute.name].push_back(&attribute);
    }
  }

  LasLayout build() {
    std::vector<LasField> standard = las_standard_fields(file_.point_format());
    standard.erase(standard.begin(), standard.begin() + 3);
    for (const LasField& field : standard) add_known(field);
    add_own_extra_bytes();
    add_new();
    put_descriptors();
    if (auto comments = las_comment_record(cloud_.comments)) {
      file_.records.push_back(std::move(*comments));
    }
    return std::move(layout_);
  }

 private:
  /// Adds the file's own extra bytes, except those with nothing left in the cloud.
  void add_own_extra_bytes() {
    std::size_t end = las_format_bytes(file_.point_format());
    std::vector<std::string> ignored;
    std::vector<LasField> fields, lost;
    if (file_.record_length() > end) fields = las_extra_fields(file_, ignored);
    descriptors_ = descriptors_of(file_);
    for (LasField& field : fields) {
      field.offset = end;
      if (add_known(field) || cloud_.empty()) {
        end += field.components * size_of(field.type);
      } else {
        lost.push_back(field);
      }
    }
    put_number(file_.header, las_header::kRecordLength, static_cast<std::uint16_t>(end));
    for (auto field = lost.rbegin(); field != lost.rend(); ++field) {
      if (field->descriptor) descriptors_.erase(*field->descriptor, las_descriptor::kBytes);
    }
  }

  /// Replaces the file's own record, which stays unchanged if nothing changed.
  void put_descriptors() {
    if (descriptors_.size() > UINT16_MAX) too_many();
    if (descriptors_ == descriptors_of(file_)) return;
    LasRecord* const record = find_record(file_.records, kExtraBytesRecord);
    if (descriptors_.empty()) {
      file_.records.erase(file_.records.begin() + (record - file_.records.data()));
    } else if (record) {
      record->data = std::move(descriptors_);
    } else {
      file_.records.push_back(
          new_record(kExtraBytesRecord, "extra bytes", std::move(descriptors_)));
    }
  }

  /// False, with zeros left in the field, if the cloud does not have it.
  bool add_known(const LasField& field) {
    taken_.insert(field.name);
    const auto channel = std::find(std::begin(kLasChannels), std::end(kLasChannels), field.name);
    if (channel != std::end(kLasChannels) && choices_.new_colours) {
      const auto c = static_cast<std::size_t>(channel - std::begin(kLasChannels));
      if (!cloud_.empty()) {
        layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(&cloud_.colours[0][c]),
                                   sizeof(Rgb), LasColumn::Scale::kColour});
      }
      return true;
    }
    if (choices_.sources.unfit.count(field.name) != 0) return add_one_return(field);
    return add_normal(field) || add_label(field) || add_source(field) || add_attribute(field) ||
           add_angle(field) || add_one_return(field);
  }

  /// Formats without returns in their source have one per pulse.
  bool add_one_return(const LasField& field) {
    static constexpr std::byte kOne{1};
    const bool counts = field.name == "ReturnNumber" || field.name == "NumberOfReturns";
    if (counts) layout_.columns.push_back({field, &kOne, 0});
    return counts;
  }

  /// From an attribute of another type or name.
  bool add_source(const LasField& field) {
    const auto source = choices_.sources.attributes.find(field.name);
    if (source == choices_.sources.attributes.end()) return false;
    const Attribute* attribute = las_source(cloud_, choices_.sources, field.name, field.type);
    if (!attribute) return false;
    used_.insert(attribute);
    const bool is_degrees =
        field.name == "ScanAngle" && lower_case(source->second) == "scananglerank";
    layout_.columns.push_back({field, attribute->bytes.data(), attribute->stride(),
                               is_degrees ? LasColumn::Scale::kAngle : LasColumn::Scale::kCast,
                               attribute->type});
    return true;
  }

  const Attribute* find_unused(const std::string& name, const LasField& field,
                               std::size_t components) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) return nullptr;
    for (const Attribute* attribute : found->second) {
      const bool fits = attribute->type == field.type && attribute->components == components;
      if (fits && used_.count(attribute) == 0) return attribute;
    }
    return nullptr;
  }

  void copy(LasField field, const Attribute& attribute) {
    used_.insert(&attribute);
    layout_.columns.push_back({std::move(field), attribute.bytes.data(), attribute.stride()});
  }

  /// As one attribute, or as the scalars into which PLY splits an array.
  bool add_attribute(const LasField& field) {
    if (const Attribute* whole = find_unused(field.name, field, field.components)) {
      copy(field, *whole);
      return true;
    }
    std::vector<const Attribute*> numbers;
    for (std::size_t c = 0; c < field.components && field.components > 1; ++c) {
      numbers.push_back(find_unused(fmt::format("{}_{}", field.name, c), field, 1));
      if (!numbers.back()) return false;
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      copy({field.name, field.type, field.offset + c * size_of(field.type)}, *numbers[c]);
    }
    return !numbers.empty();
  }

  bool add_normal(const LasField& field) {
    const auto& stored = cloud_.stored_normals;
    std::size_t axis = 0;
    const auto is_axis = [&] {
      return field.name == kLasNormals[axis] ||
             (!stored.empty() && field.name == stored[axis].name);
    };
    while (axis < 3 && !is_axis()) ++axis;
    if (axis == 3) return false;
    const bool as_stored = keep_stored_ && !stored.empty() && stored[axis].type == field.type &&
                           stored[axis].bytes.size() == cloud_.size() * size_of(field.type);
    if (as_stored) {
      copy(field, stored[axis]);
    } else if (cloud_.has_normals() && is_floating(field.type)) {
      const auto* number = cloud_.normals[0].data() + axis;
      layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(number), sizeof(Vec3),
                                 LasColumn::Scale::kNormal});
    } else {
      // Integers cannot hold new normals: these get separate fields.
      const bool outdated = cloud_.has_normals() && options_.new_normals;
      if (outdated) used_.insert(by_name_[field.name].begin(), by_name_[field.name].end());
      return false;
    }
    return has_normals_ = true;
  }

  bool add_label(const LasField& field) {
    if (field.name != "label" || field.type != ScalarType::kUint8 || !cloud_.has_labels()) {
      return false;
    }
    layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(cloud_.labels.data()), 1});
    return has_label_ = true;
  }

  /// The scan angle of formats 6 to 10 from that of formats 0 to 5.
  bool add_angle(const LasField& field) {
    if (!choices_.promoted || field.name != "ScanAngle") return false;
    const Attribute* rank = find_unused("ScanAngleRank", {"", ScalarType::kInt8}, 1);
    if (!rank) return false;
    used_.insert(rank);
    layout_.columns.push_back(
        {field, rank->bytes.data(), 1, LasColumn::Scale::kAngle, ScalarType::kInt8});
    return true;
  }

  void add_new() {
    if (cloud_.has_normals() && !has_normals_ && options_.new_normals) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool wide = keep_stored_ && cloud_.stored_normals[axis].type == ScalarType::kFloat64;
        add_normal(
            new_field(kLasNormals[axis], wide ? ScalarType::kFloat64 : ScalarType::kFloat32));
      }
    }
    const std::vector<const Attribute*> left = attributes_left();
    const auto names = las_extra_names(left, taken_, layout_.losses);
    for (std::size_t a = 0; a < left.size(); ++a) {
      const Attribute& attribute = *left[a];
      for (std::size_t c = 0; c < attribute.components; ++c) {
        layout_.columns.push_back({new_field(names[a][c], attribute.type),
                                   attribute.bytes.data() + c * size_of(attribute.type),
                                   attribute.stride()});
      }
    }
    if (cloud_.has_labels() && !has_label_ && !choices_.label_is_class) {
      add_label(new_field("label", ScalarType::kUint8));
    }
  }

  /// The attributes that no field has taken.
  std::vector<const Attribute*> attributes_left() const {
    const bool has_result = find_attribute(cloud_, "scalar_p_sharp") != nullptr;
    std::vector<const Attribute*> left;
    for (const Attribute& attribute : cloud_.attributes) {
      const bool derived = attribute.name == "quality" && has_result;
      if (used_.count(&attribute) != 0 || derived || is_replaced(attribute.name)) continue;
      left.push_back(&attribute);
    }
    return left;
  }

  /// Whether the colours are written in its place.
  bool is_replaced(const std::string& name) const {
    return std::find(std::begin(kLasChannels), std::end(kLasChannels), name) !=
               std::end(kLasChannels) &&
           taken_.count(name) != 0 && choices_.sources.unfit.count(name) == 0;
  }

  LasField new_field(const std::string& name, ScalarType type) {
    LasField field{name, type, file_.record_length()};
    const std::size_t length = file_.record_length() + size_of(type);
    if (length > UINT16_MAX) too_many();
    if (!std::exchange(all_described_, true)) describe_undocumented();
    put_number(file_.header, las_header::kRecordLength, static_cast<std::uint16_t>(length));
    descriptors_ += las_extra_descriptor(field);
    return field;
  }

  [[noreturn]] static void too_many() {
    throw Error(ErrorKind::kFailure, "the points have more attributes than LAS can hold");
  }

  /// New extra bytes follow those of the file, which must be described for that.
  void describe_undocumented() {
    for (std::size_t at = descriptors_.size(); at > 0;) {
      at -= las_descriptor::kBytes;
      const bool no_bytes = descriptors_[at + las_descriptor::kType] == 0 &&
                            descriptors_[at + las_descriptor::kOptions] == 0;
      if (no_bytes) descriptors_.erase(at, las_descriptor::kBytes);
    }
    LasFile described = file_;
    described.records = {new_record(kExtraBytesRecord, "", descriptors_)};
    std::vector<std::string> warnings;
    const auto fields = las_extra_fields(described, warnings);
    const std::size_t count = descriptors_.size() / las_descriptor::kBytes;
    if (fields.size() <= count) {
      descriptors_.resize(fields.size() * las_descriptor::kBytes);
      return;
    }
    LasField rest = fields.back();
    for (std::size_t left = rest.components; left > 0;) {
      rest.components = std::min<std::size_t>(left, 255);
      left -= rest.components;
      std::string bytes = las_extra_descriptor(rest);
      put_number<std::uint8_t>(bytes, las_descriptor::kType, 0);
      put_number(bytes, las_descriptor::kOptions, static_cast<std::uint8_t>(rest.components));
      descriptors_ += bytes;
    }
  }

  const PointCloud& cloud_;
  const WriteOptions& options_;
  const LasChoices& choices_;
  LasLayout layout_;
  LasFile& file_;
  std::string descriptors_;
  std::map<std::string, std::vector<const Attribute*>> by_name_;
  std::set<std::string> taken_;
  std::set<const Attribute*> used_;
  bool keep_stored_;  ///< the normals of the file, rather than unit ones
  bool has_normals_ = false, has_label_ = false, all_described_ = false;
};

}  // namespace

void write_scaled(const LasColumn& column, const std::byte* from, char* to) {
  if (column.scale == LasColumn::Scale::kCast) {
    const double number = to_double(column.stored, from);
    return visit_scalar(column.field.type,
                        [&](auto zero) { store(to, static_cast<decltype(zero)>(number)); });
  }
  if (column.scale == LasColumn::Scale::kColour) {
    const auto wide = static_cast<std::uint16_t>(std::to_integer<unsigned>(*from) * 257U);
    return store(to, wide);
  }
  if (column.scale == LasColumn::Scale::kAngle) {
    const double degrees = to_double(column.stored, from);
    const auto steps = static_cast<std::int16_t>(std::lround(degrees / kLasAngleStep));
    return store(to, steps);
  }
  const auto number = load<double>(from);
  if (column.field.type == ScalarType::kFloat64) return store(to, number);
  store(to, static_cast<float>(number));
}

LasLayout las_layout(const PointCloud& part, const WriteOptions& options,
                     const LasChoices& choices) {
  return LayoutBuilder(part, options, choices).build();
}

}  // namespace pcednet::io
