#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pcednet/io/input_file.h"

namespace pcednet::io {

/// The lines of a text file as Lines gives them, without its byte-order mark. A part of the file is
/// in memory at a time; all of it if it is UTF-16, which becomes UTF-8. The file must outlive it.
class FileLines {
 public:
  explicit FileLines(const InputFile& file);

  /// Moves to the next line and puts it, without its end, in `line`, which holds until the next
  /// call; false after the last.
  bool next(std::string_view& line);
  /// The same to the next line that is not blank.
  bool next_filled(std::string_view& line);

  /// Number of the line that next() gave last, counted from 1.
  std::size_t number() const { return number_; }

  /// Where next() goes on, in a text that is not UTF-16.
  struct Place {
    std::uint64_t byte = 0;
    std::size_t lines_before = 0;
  };
  Place place() const { return {read_ - (text_.size() - next_), number_}; }
  /// Goes on there, a place in the same file.
  void go_to(const Place& place);

 private:
  bool read_more();
  std::size_t find_end(std::size_t from);

  const InputFile* file_;
  std::uint64_t read_ = 0;  ///< bytes of the file
  std::string text_ = {};   ///< those that are in memory
  std::size_t next_ = 0;    ///< where the next line begins in them
  std::size_t number_ = 0;
  char end_ = 0;  ///< of lines, once one is there
};

}  // namespace pcednet::io
