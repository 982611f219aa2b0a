#include <algorithm>
#include <iterator>

#include "pcednet/io/las/copc.h"
#include "pcednet/io/las/merge.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// The point format of COPC with the colours of `format`.
unsigned copc_format(unsigned format, const PointCloud& first) {
  if (las_format_has(format, "Infrared")) return 8;
  if (!las_format_has(format, "Red")) return 6;
  const Attribute* infrared = find_attribute(first, "Infrared");
  return infrared && infrared->type == ScalarType::kUint16 ? 8 : 7;
}

}  // namespace

bool is_copc_name(const std::filesystem::path& path) {
  return lower_case(path.filename().string()).ends_with(".copc.laz");
}

void choose_copc(LasChoices& choices, const PointCloud& first) {
  LasFile& file = choices.file;
  const unsigned before = file.point_format(), format = copc_format(before, first);
  std::vector<std::string> lost = promote_las(file, format);
  std::ranges::move(lost, std::back_inserter(choices.losses));
  const auto is_copc = [](const LasRecord& record) {
    return record.user_id == kCopcInfoRecord.user_id;
  };
  std::erase_if(file.records, is_copc);  // of another file that became LAS
  std::erase_if(file.extended_records, is_copc);
  file.records.insert(file.records.begin(), new_record(kCopcInfoRecord, "COPC info",
                                                       std::string(copc_info::kBytes, '\0')));
  choices.promoted = before != format;
}

}  // namespace pcednet::io
