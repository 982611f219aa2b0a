#include "las_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"

namespace pcednet::app {
namespace {

using nlohmann::ordered_json;

std::string text_at(const std::string& header, std::size_t offset) {
  const std::string field = header.substr(offset, 32);
  return field.substr(0, field.find('\0'));
}

/// The WKT, or the citations of GeoTIFF keys, which stand in a text separated by bars.
std::string coordinate_system(const io::LasFile& file) {
  std::string citations;
  for (const auto* records : {&file.records, &file.extended_records}) {
    for (const io::LasRecord& record : *records) {
      const std::string text = record.data.substr(0, record.data.find('\0'));
      if (record.is("LASF_Projection", 2112)) return text;
      if (record.is("LASF_Projection", 34737)) citations = text;
    }
  }
  std::replace(citations.begin(), citations.end(), '|', ' ');
  return citations;
}

/// How many points have each value of a field.
ordered_json counts_of(const PointCloud& cloud, const char* name) {
  ordered_json counts = ordered_json::object();
  const Attribute* field = find_attribute(cloud, name);
  if (!field) return counts;
  std::map<int, std::size_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) ++found[static_cast<int>(field->value(i))];
  for (const auto& [value, count] : found) counts[std::to_string(value)] = count;
  return counts;
}

std::string listed(const ordered_json& counts) {
  std::string text;
  for (const auto& [value, count] : counts.items()) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", value, count.dump());
  }
  return text;
}

void print(const char* name, const std::string& text) {
  if (!text.empty()) fmt::print("  {:<14} {}\n", name, text);
}

}  // namespace

ordered_json las_facts(const std::filesystem::path& path, const PointCloud& cloud) {
  std::vector<std::string> warnings;  // read_cloud() told them
  const io::LasFile file = io::read_las_file(io::InputFile(path), warnings);
  ordered_json facts = {{"version", fmt::format("1.{}", file.minor_version())},
                        {"point_format", file.point_format()},
                        {"compressed", file.compressed()},
                        {"system", text_at(file.header, 26)},
                        {"software", text_at(file.header, 58)},
                        {"created_day", io::number_at<std::uint16_t>(file.header, 90)},
                        {"created_year", io::number_at<std::uint16_t>(file.header, 92)},
                        {"scale", {file.scale(0), file.scale(1), file.scale(2)}},
                        {"offset", {file.offset(0), file.offset(1), file.offset(2)}},
                        {"coordinate_system", coordinate_system(file)},
                        {"records", ordered_json::array()},
                        {"extra_bytes", ordered_json::array()},
                        {"points_by_return", counts_of(cloud, "ReturnNumber")},
                        {"points_by_class", counts_of(cloud, "Classification")}};
  for (const auto* records : {&file.records, &file.extended_records}) {
    for (const io::LasRecord& record : *records) {
      facts["records"].push_back({{"user_id", record.user_id},
                                  {"record_id", record.record_id},
                                  {"description", record.description},
                                  {"bytes", record.data.size()}});
    }
  }
  for (const io::LasField& field : io::las_extra_fields(file, warnings)) {
    facts["extra_bytes"].push_back(field.name);
  }
  return facts;
}

void print_las_facts(const ordered_json& facts) {
  const auto text = [&](const char* key) { return facts[key].get<std::string>(); };
  print("version",
        fmt::format("LAS {}, point format {}{}", text("version"), facts["point_format"].dump(),
                    facts["compressed"].get<bool>() ? ", LASzip" : ""));
  print("made by", fmt::format("{} / {}, day {} of {}", text("system"), text("software"),
                               facts["created_day"].dump(), facts["created_year"].dump()));
  print("scale", facts["scale"].dump());
  print("offset", facts["offset"].dump());
  print("coordinates", text("coordinate_system"));
  for (const ordered_json& record : facts["records"]) {
    print("record", fmt::format("{} {}, {} bytes, {}", record["user_id"].get<std::string>(),
                                record["record_id"].dump(), record["bytes"].dump(),
                                record["description"].get<std::string>()));
  }
  print("by return", listed(facts["points_by_return"]));
  print("by class", listed(facts["points_by_class"]));
}

}  // namespace pcednet::app
