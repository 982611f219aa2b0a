#include "classify_tiles.h"

#include "pcednet/formats/parts.h"

namespace pcednet::app {

std::vector<std::string> write_tiled(const std::filesystem::path& output, const TiledCloud& cloud,
                                     const TiledResult& result, const Progress& progress) {
  const auto each = [&](const std::function<bool(const PointCloud&)>& visit) {
    cloud.each([&](PointCloud& part, const tiles::TileFindings& findings) {
      throw_if_cancelled(&progress);
      result.add_result(part, findings);
      return visit(part);
    });
  };
  PointCloud first;
  each([&](const PointCloud& part) {
    first = part;
    return false;
  });
  const std::size_t points = cloud.plan().points();
  io::WriteOptions options = result.write;
  options.new_normals = !cloud.plan().normals.made;
  options.progress = &progress;
  const auto writer = formats::create_parts(
      output, {.points = points, .first = &first, .each_part = each, .is_las = cloud.is_las()},
      options);
  Stage stage(&progress, "write", points);
  std::size_t before = 0;
  each([&](const PointCloud& part) {
    writer->append(part);
    result.see(part, before);
    before += part.size();
    stage.advance(part.size());
    return true;
  });
  writer->commit();
  return writer->losses;
}

}  // namespace pcednet::app
