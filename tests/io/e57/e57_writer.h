#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "io/scratch.h"

namespace pcednet::io {

/// A field of the points to write: its element in the prototype, and its bits point by point.
struct E57TestField {
  std::string xml;
  unsigned bits = 0;
  std::vector<std::uint64_t> values = {};  ///< without the minimum; floats by their bits
};

struct E57TestScan {
  std::string xml;  ///< further children: name, pose, colorLimits, ...
  std::vector<E57TestField> fields = {};
  std::size_t points = 0;
};

inline E57TestField e57_double(const std::string& name, const std::vector<double>& values) {
  E57TestField field{"<" + name + " type=\"Float\"/>", 64, {}};
  for (const double value : values) field.values.push_back(std::bit_cast<std::uint64_t>(value));
  return field;
}

inline E57TestField e57_single(const std::string& name, const std::vector<float>& values) {
  E57TestField field{"<" + name + " type=\"Float\" precision=\"single\"/>", 32, {}};
  for (const float value : values) field.values.push_back(std::bit_cast<std::uint32_t>(value));
  return field;
}

/// `attributes` may scale the integers.
inline E57TestField e57_integer(const std::string& name, std::int64_t least, std::int64_t largest,
                                const std::vector<std::int64_t>& values,
                                const std::string& attributes = "type=\"Integer\"") {
  E57TestField field;
  field.xml = "<" + name + " " + attributes + " minimum=\"" + std::to_string(least) +
              "\" maximum=\"" + std::to_string(largest) + "\"/>";
  std::uint64_t range = static_cast<std::uint64_t>(largest) - static_cast<std::uint64_t>(least);
  for (; range != 0; range >>= 1) ++field.bits;
  for (const std::int64_t value : values) {
    field.values.push_back(static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(least));
  }
  return field;
}

/// CRC-32C bit by bit.
inline std::uint32_t slow_crc32c(std::string_view bytes) {
  std::uint32_t rest = 0xFFFFFFFF;
  for (const char c : bytes) {
    rest ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? 0x82F63B78 : 0);
  }
  return ~rest;
}

inline std::string e57_bytestream(const E57TestField& field) {
  std::string bytes;
  unsigned used = 0;
  for (const std::uint64_t value : field.values) {
    for (unsigned bit = 0; bit < field.bits; ++bit, used = (used + 1) % 8) {
      if (used == 0) bytes += '\0';
      bytes.back() =
          static_cast<char>(bytes.back() | static_cast<char>((value >> bit & 1) << used));
    }
  }
  return bytes;
}

inline std::uint64_t e57_physical(std::uint64_t logical) {
  return logical / 1020 * 1024 + logical % 1020;
}

/// A data packet with the next bytes of every stream: of each, by turns, one byte more or less than
/// `most`, so that values are cut anywhere.
inline std::string e57_packet(std::vector<std::string>& streams, std::size_t most) {
  std::string lengths, bodies;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    const std::string body = streams[s].substr(0, most + s % 3);
    streams[s].erase(0, body.size());
    lengths += packed(static_cast<std::uint16_t>(body.size()));
    bodies += body;
  }
  std::size_t length = 6 + lengths.size() + bodies.size();
  while (length % 4 != 0) ++length, bodies += '\0';
  return packed(std::uint8_t{1}, std::uint8_t{0}, static_cast<std::uint16_t>(length - 1),
                static_cast<std::uint16_t>(streams.size())) +
         lengths + bodies;
}

/// The section of a scan's points that begins at logical byte `at`.
inline std::string e57_section(const E57TestScan& scan, std::uint64_t at, std::size_t most,
                               bool with_index) {
  std::string index;
  if (with_index) {
    index = packed(std::uint8_t{0}, std::uint8_t{0}, std::uint16_t{15}) + std::string(12, '\0');
  }
  std::string packets = index;
  std::vector<std::string> streams;
  for (const E57TestField& field : scan.fields) streams.push_back(e57_bytestream(field));
  const auto left = [&] {
    std::size_t bytes = 0;
    for (const std::string& stream : streams) bytes += stream.size();
    return bytes;
  };
  while (left() > 0) packets += e57_packet(streams, most) + index;
  return packed(std::uint64_t{1}, std::uint64_t{32 + packets.size()}, e57_physical(at + 32),
                std::uint64_t{0}) +
         packets;
}

/// `content` cut into pages, each with its checksum.
inline std::string e57_pages(std::string content) {
  content.resize((content.size() + 1019) / 1020 * 1020);
  std::string file;
  for (std::size_t at = 0; at < content.size(); at += 1020) {
    const std::string page = content.substr(at, 1020);
    file += page + packed_reversed(slow_crc32c(page));
  }
  return file;
}

/// An E57 file with these scans; packets hold about `most` bytes of each field, and stand between
/// index packets if `with_index`.
inline std::string e57_file(const std::vector<E57TestScan>& scans, std::size_t most = 7,
                            bool with_index = true) {
  std::string content(48, '\0');
  std::string xml =
      "<?xml version=\"1.0\"?>\n<e57Root type=\"Structure\" "
      "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
      "xmlns:nor=\"http://www.libe57.org/E57_NOR_surface_normals.txt\">"
      "<formatName type=\"String\">ASTM E57 3D Imaging Data File</formatName>"
      "<guid type=\"String\">{1}</guid><versionMajor type=\"Integer\">1</versionMajor>"
      "<versionMinor type=\"Integer\"/><data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">";
  for (const E57TestScan& scan : scans) {
    xml += "<vectorChild type=\"Structure\"><guid type=\"String\">{2}</guid>" + scan.xml +
           "<points type=\"CompressedVector\" fileOffset=\"" +
           std::to_string(e57_physical(content.size())) + "\" recordCount=\"" +
           std::to_string(scan.points) + "\"><prototype type=\"Structure\">";
    for (const E57TestField& field : scan.fields) xml += field.xml;
    xml +=
        "</prototype><codecs type=\"Vector\" "
        "allowHeterogeneousChildren=\"1\"/></points></vectorChild>";
    content += e57_section(scan, content.size(), most, with_index);
  }
  xml += "</data3D><images2D type=\"Vector\" allowHeterogeneousChildren=\"1\"/></e57Root>";
  const std::uint64_t xml_at = content.size();
  content += xml;
  const std::uint64_t pages = (content.size() + 1019) / 1020;
  content.replace(0, 48,
                  "ASTM-E57" + packed(1U, 0U, pages * 1024, e57_physical(xml_at),
                                      std::uint64_t{xml.size()}, std::uint64_t{1024}));
  return e57_pages(content);
}

}  // namespace pcednet::io
