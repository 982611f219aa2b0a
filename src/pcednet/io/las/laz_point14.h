#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "pcednet/io/las/laz_items.h"

namespace pcednet::io::laz {

/// The scanner channel of a POINT14.
inline unsigned channel_of(const std::byte* item) {
  return std::to_integer<unsigned>(item[15]) >> 4 & 3;
}

/// POINT14: the 30 bytes that formats 6 to 10 share, in nine layers, with models of their own for
/// each of four scanner channels.
class Point14 {
 public:
  explicit Point14(const std::byte* first);
  ~Point14();
  Point14(const Point14&) = delete;
  Point14& operator=(const Point14&) = delete;

  /// Codes a point; a layer without a coder stays constant. Returns the point's scanner channel.
  template <typename Coder>
  unsigned code(const std::array<Coder*, 9>& coders, std::byte* item);

 private:
  struct Channel;
  struct Changes {
    bool source = false, time = false, angle = false;
  };

  template <typename Coder>
  Changes code_returns(Coder& coder, const std::byte* item);
  template <typename Coder>
  void code_position(Coder& coder, Coder* z_coder, const std::byte* item, bool time_changes);
  template <typename Coder>
  void code_rest(const std::array<Coder*, 9>& coders, const std::byte* item,
                 const Changes& changes);

  std::array<std::unique_ptr<Channel>, 4> channels_;
  unsigned current_ = 0;
};

}  // namespace pcednet::io::laz
