#include "pcednet/nn/safetensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <utility>

#include "pcednet/core/bytes.h"
#include "pcednet/core/error.h"
#include "pcednet/core/json.h"

namespace pcednet::nn {
namespace {

constexpr std::size_t kPrefix = 8;               // the header's length, little-endian
constexpr std::size_t kMostHeader = 100u << 20;  // as in the format's own reader
constexpr const char* kMetadata = "__metadata__";

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

[[noreturn]] void refuse(const std::string& name, std::size_t byte, const std::string& what) {
  throw Error(ErrorKind::kModelMismatch,
              fmt::format("{}: byte {}: {}; not a complete safetensors file", name, byte, what));
}

std::size_t header_length(std::string_view prefix, std::size_t file_size, const std::string& name) {
  if (file_size < kPrefix) refuse(name, file_size, "the file ends before the header");
  const auto length = load<std::uint64_t>(prefix.data());
  if (length > kMostHeader || length > file_size - kPrefix) {
    refuse(name, 0, fmt::format("a header of {} bytes in a file of {}", length, file_size));
  }
  return static_cast<std::size_t>(length);
}

/// The header as JSON: no doubled names, no nesting beyond what the format has.
Json parse_header(std::string_view text, const std::string& name) {
  std::set<std::string> names[3];
  const auto check = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > 3) refuse(name, kPrefix, "values nested too deep");
    if (event == Json::parse_event_t::object_start && depth < 3) names[depth].clear();
    if (event == Json::parse_event_t::key && depth <= 2 &&
        !names[depth - 1].insert(value.get<std::string>()).second) {
      refuse(name, kPrefix, fmt::format("\"{}\" is there twice", value.get<std::string>()));
    }
    return true;
  };
  try {
    Json header = Json::parse(text.begin(), text.end(), check);
    if (!header.is_object()) refuse(name, kPrefix, "the header is not a JSON object");
    return header;
  } catch (const Json::parse_error& error) {
    refuse(name, kPrefix + error.byte, "the header is not JSON");
  } catch (const Json::exception&) {
    refuse(name, kPrefix, "the header holds a number that is too large");
  }
}

struct Placed {
  std::size_t begin = 0, end = 0;  ///< in the data
  std::string name;
  Tensor tensor;
};

std::size_t whole_number(const Json& value, const std::string& file, const std::string& tensor) {
  if (!value.is_number_unsigned()) {
    refuse(file, kPrefix, fmt::format("tensor \"{}\": a size that is not a whole number", tensor));
  }
  return value.get<std::size_t>();
}

Placed place(const std::string& tensor, const Json& entry, std::size_t data_size,
             const std::string& file) {
  const auto bad = [&](const std::string& what) {
    refuse(file, kPrefix, fmt::format("tensor \"{}\": {}", tensor, what));
  };
  if (!entry.is_object() || entry.size() != 3 || !entry.contains("dtype") ||
      !entry.contains("shape") || !entry.contains("data_offsets")) {
    bad("not the three entries dtype, shape and data_offsets");
  }
  if (entry["dtype"] != "F32") {
    bad(fmt::format("type {}; only F32 is used", to_text(entry["dtype"])));
  }
  const Json& offsets = entry["data_offsets"];
  if (!entry["shape"].is_array() || !offsets.is_array() || offsets.size() != 2) {
    bad("shape and data_offsets must be lists");
  }
  Placed placed;
  placed.name = tensor;
  placed.begin = whole_number(offsets[0], file, tensor);
  placed.end = whole_number(offsets[1], file, tensor);
  if (placed.begin > placed.end || placed.end > data_size) {
    bad(fmt::format("data from {} to {} of {} bytes", placed.begin, placed.end, data_size));
  }
  std::size_t bytes = sizeof(float);
  for (const Json& size : entry["shape"]) {
    placed.tensor.shape.push_back(whole_number(size, file, tensor));
    if (__builtin_mul_overflow(bytes, placed.tensor.shape.back(), &bytes)) bad("shape too large");
  }
  if (bytes != placed.end - placed.begin) {
    bad(fmt::format("a shape of {} bytes in {}", bytes, placed.end - placed.begin));
  }
  return placed;
}

}  // namespace

std::string encode_safetensors(const Safetensors& content) {
  Json header = Json::object();
  if (!content.metadata.empty()) header[kMetadata] = content.metadata;
  std::size_t offset = 0;
  for (const auto& [name, tensor] : content.tensors) {
    const std::size_t size = tensor.values.size() * sizeof(float);
    header[name] = {
        {"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {offset, offset + size}}};
    offset += size;
  }
  std::string text = to_text(header, -1, NotUtf8::kReplace);
  text.resize((text.size() + 7) / 8 * 8, ' ');  // so that the data is aligned
  std::string bytes(kPrefix, '\0');
  store(bytes.data(), std::uint64_t{text.size()});
  bytes += text;
  for (const auto& [name, tensor] : content.tensors) {
    bytes.append(reinterpret_cast<const char*>(tensor.values.data()),
                 tensor.values.size() * sizeof(float));
  }
  return bytes;
}

Safetensors decode_safetensors(std::string_view bytes, const std::string& name) {
  const std::size_t header_size = header_length(bytes, bytes.size(), name);
  const Json header = parse_header(bytes.substr(kPrefix, header_size), name);
  const std::string_view data = bytes.substr(kPrefix + header_size);
  Safetensors content;
  std::vector<Placed> placed;
  for (const auto& [key, entry] : header.items()) {
    if (key != kMetadata) {
      placed.push_back(place(key, entry, data.size(), name));
      continue;
    }
    if (!entry.is_object()) refuse(name, kPrefix, "the metadata is not a JSON object");
    for (const auto& [item, text] : entry.items()) {
      if (!text.is_string()) refuse(name, kPrefix, fmt::format("metadata \"{}\" is no text", item));
      content.metadata[item] = text.get<std::string>();
    }
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::size_t end = 0;
  for (Placed& p : placed) {
    if (p.begin != end) {
      refuse(name, kPrefix + header_size + end, "the tensors leave a hole or overlap");
    }
    end = p.end;
    p.tensor.values.resize((p.end - p.begin) / sizeof(float));
    if (p.end > p.begin)
      std::memcpy(p.tensor.values.data(), data.data() + p.begin, p.end - p.begin);
    content.tensors[p.name] = std::move(p.tensor);
  }
  if (end != data.size()) {
    refuse(name, kPrefix + header_size + end, "bytes after the last tensor");
  }
  return content;
}

Safetensors read_safetensors(const std::filesystem::path& path) {
  const std::string name = path.string();
  const auto unreadable = [&](const std::string& why) {
    return Error(ErrorKind::kUnreadable, fmt::format("{}: {}", name, why));
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (is_directory(status)) throw unreadable("is a folder");
  if (exists(status) && !is_regular_file(status)) throw unreadable("is not a regular file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw unreadable(std::strerror(errno));
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw unreadable(error.message());
  std::string bytes(std::min<std::uintmax_t>(size, kPrefix), '\0');
  const auto read = [&](char* to, std::uintmax_t count) {
    if (!file.read(to, static_cast<std::streamsize>(count))) throw unreadable("cannot be read");
  };
  read(bytes.data(), bytes.size());
  // Before the rest is read, which for a foreign file may be large.
  header_length(bytes, static_cast<std::size_t>(size), name);
  bytes.resize(static_cast<std::size_t>(size));
  read(bytes.data() + kPrefix, size - kPrefix);
  return decode_safetensors(bytes, name);
}

void write_safetensors(const std::filesystem::path& path, const Safetensors& content,
                       Overwrite overwrite) {
  OutputFile file(path, overwrite);
  file.write(encode_safetensors(content));
  file.commit();
}

}  // namespace pcednet::nn
