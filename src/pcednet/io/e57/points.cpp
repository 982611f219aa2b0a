#include "pcednet/io/e57/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "pcednet/core/bytes.h"

namespace pcednet::io {
namespace {

/// The values of one field, decoded as their bytes arrive: the bytestream goes on from packet to
/// packet, so that a value may begin in one and end in the next.
class Bytestream {
 public:
  Bytestream(const E57Field& field, std::size_t points)
      : field_(field),
        bits_(field.bits()),
        range_(static_cast<std::uint64_t>(field.largest) -
               static_cast<std::uint64_t>(field.least)) {
    values_ = {field.name, field.type(), 1, {}};
    points_ = field.kind == E57Field::Kind::kString ? 0 : points;
    values_.bytes.resize(points_ * values_.stride());
    if (bits_ == 0) decode(0);
  }

  bool complete() const { return done_ == points_; }
  std::size_t done() const { return done_; }
  bool in_range() const { return in_range_; }  ///< no integer so far is above the field's largest
  Attribute take() { return std::move(values_); }

  void append(std::span<const std::byte> bytes) {
    if (complete()) return;
    pending_.insert(pending_.end(), bytes.begin(), bytes.end());
    const std::size_t end = pending_.size();
    pending_.resize(end + 9);  // a value is read from nine bytes, wherever it ends
    const std::size_t used_bits = decode(end * 8);
    first_bit_ = used_bits % 8;
    pending_.resize(end);
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(used_bits / 8));
  }

 private:
  /// `bits_` bits from bit `at` of what is pending.
  std::uint64_t bits_at(std::size_t at) const {
    if (bits_ == 0) return 0;
    const std::byte* first = pending_.data() + at / 8;
    const unsigned shift = at % 8;
    std::uint64_t bits = load<std::uint64_t>(first) >> shift;
    if (shift + bits_ > 64) {
      bits |= std::to_integer<std::uint64_t>(first[8]) << (64 - shift);
    }
    return bits_ == 64 ? bits : bits & ((std::uint64_t{1} << bits_) - 1);
  }

  /// Decodes what ends before bit `end`; returns the bit after it.
  std::size_t decode(std::size_t end) {
    std::size_t at = first_bit_;
    visit_scalar(values_.type, [&](auto value) {
      std::byte* out = values_.bytes.data() + done_ * sizeof value;
      for (; done_ < points_ && at + bits_ <= end; ++done_, at += bits_, out += sizeof value) {
        const std::uint64_t bits = bits_at(at);
        if (field_.is_integer()) {
          in_range_ = in_range_ && bits <= range_;
          const auto whole =
              static_cast<std::int64_t>(bits + static_cast<std::uint64_t>(field_.least));
          value = field_.kind == E57Field::Kind::kInteger
                      ? static_cast<decltype(value)>(whole)
                      : static_cast<decltype(value)>(static_cast<double>(whole) * field_.scale +
                                                     field_.offset);
        } else {
          std::memcpy(&value, &bits, sizeof value);
        }
        std::memcpy(out, &value, sizeof value);
      }
    });
    return at;
  }

  const E57Field& field_;
  unsigned bits_;
  std::uint64_t range_;
  bool in_range_ = true;
  std::size_t points_ = 0;
  std::size_t done_ = 0;
  std::size_t first_bit_ = 0;  ///< in the first pending byte
  std::vector<std::byte> pending_;
  Attribute values_;
};

Error damaged(const E57Pages& pages, const E57Scan& scan, const std::string& what) {
  return unreadable(pages.file().path(), fmt::format("scan {:.60}: {}", scan.name, what));
}

/// Where the packets of a section are, in logical bytes.
struct Section {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

Section find_section(const E57Pages& pages, const E57Scan& scan) {
  const std::uint64_t start = pages.logical(scan.points_offset, "the points of a scan");
  std::array<std::byte, 32> header = {};
  pages.read(start, header);
  if (std::to_integer<int>(header[0]) != 1) {
    throw damaged(pages, scan, fmt::format("no section of points at byte {}", scan.points_offset));
  }
  const auto length = load<std::uint64_t>(&header[8]);
  const std::uint64_t begin =
      pages.logical(load<std::uint64_t>(&header[16]), "the first packet of a scan");
  return {begin, start + std::min(length, pages.size() - start)};
}

class PacketReader {
 public:
  PacketReader(const E57Pages& pages, const E57Scan& scan) : pages_(pages), scan_(scan) {
    for (const E57Field& field : scan.fields) {
      streams_.emplace_back(field, static_cast<std::size_t>(scan.points));
    }
  }

  std::vector<Attribute> read(const Section& section) {
    std::uint64_t at = section.begin;
    while (!complete()) {
      if (at >= section.end || section.end - at < 4) throw ends_early(at);
      at += read_packet(at);
    }
    std::vector<Attribute> fields;
    for (Bytestream& stream : streams_) fields.push_back(stream.take());
    return fields;
  }

 private:
  bool complete() const {
    return std::all_of(streams_.begin(), streams_.end(),
                       [](const Bytestream& s) { return s.complete(); });
  }

  Error ends_early(std::uint64_t at) const {
    std::size_t least = static_cast<std::size_t>(scan_.points);
    for (const Bytestream& stream : streams_) {
      if (!stream.complete()) least = std::min(least, stream.done());
    }
    return damaged(pages_, scan_,
                   fmt::format("the packets end after {} of {} points, at byte {} "
                               "of the pages",
                               least, scan_.points, at));
  }

  /// Reads the packet at logical byte `at`; returns its length.
  std::uint64_t read_packet(std::uint64_t at) {
    constexpr int kData = 1;
    std::array<std::byte, 4> start = {};
    pages_.read(at, start);
    const std::size_t length = std::size_t{load<std::uint16_t>(&start[2])} + 1;
    const int type = std::to_integer<int>(start[0]);
    if (type > 2 || length < 4) {
      throw damaged(pages_, scan_,
                    fmt::format("byte {} of the pages: a packet of type {} with {} "
                                "bytes",
                                at, type, length));
    }
    if (type != kData) return length;  // an index, or one to be ignored
    packet_.resize(length);
    pages_.read(at, packet_);
    take_data(at);
    return length;
  }

  void take_data(std::uint64_t at) {
    const std::size_t count = streams_.size();
    std::size_t offset = 6 + 2 * count;
    if (packet_.size() < offset || load<std::uint16_t>(&packet_[4]) != count) {
      throw damaged(pages_, scan_,
                    fmt::format("byte {} of the pages: a packet that is not for {} "
                                "fields",
                                at, count));
    }
    for (std::size_t s = 0; s < count; ++s) {
      const std::size_t bytes = load<std::uint16_t>(&packet_[6 + 2 * s]);
      if (bytes > packet_.size() - offset) {
        throw damaged(pages_, scan_,
                      fmt::format("byte {} of the pages: {} bytes of {} do not fit "
                                  "in their packet",
                                  at, bytes, scan_.fields[s].name));
      }
      streams_[s].append(std::span<const std::byte>(packet_).subspan(offset, bytes));
      offset += bytes;
      if (streams_[s].in_range()) continue;
      throw damaged(pages_, scan_,
                    fmt::format("byte {} of the pages: a {} above its maximum of {}", at,
                                scan_.fields[s].name, scan_.fields[s].largest));
    }
  }

  const E57Pages& pages_;
  const E57Scan& scan_;
  std::vector<Bytestream> streams_;
  std::vector<std::byte> packet_;
};

}  // namespace

void check_e57_sizes(const E57Pages& pages, const std::vector<E57Scan>& scans) {
  // Fields of a single value take no bits in the file, but bytes here.
  std::uint64_t numbers_left = 64 * pages.size(), bits_left = 8 * pages.size();
  for (const E57Scan& scan : scans) {
    std::uint64_t bits = 0;
    for (const E57Field& field : scan.fields) bits += field.bits();
    const std::uint64_t numbers = scan.fields.size() + 1;
    if (scan.points > numbers_left / numbers || (bits > 0 && scan.points > bits_left / bits)) {
      throw damaged(pages, scan,
                    fmt::format("declares {} points of {} bits, more than the file can hold",
                                scan.points, bits));
    }
    numbers_left -= scan.points * numbers;
    bits_left -= scan.points * bits;
  }
}

std::vector<Attribute> read_e57_points(const E57Pages& pages, const E57Scan& scan) {
  if (scan.points == 0) {
    std::vector<Attribute> none;
    for (const E57Field& field : scan.fields) none.push_back({field.name, field.type(), 1, {}});
    return none;
  }
  return PacketReader(pages, scan).read(find_section(pages, scan));
}

}  // namespace pcednet::io
