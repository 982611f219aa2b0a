#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <vector>

namespace pcednet::python {

/// Text of a file or a file name as a str. Bytes that are not UTF-8, as of Latin-1, become
/// surrogates, as in Python's own file names.
pybind11::str text_of(std::string_view bytes);
pybind11::list texts_of(const std::vector<std::string>& all);

/// The inverse.
std::string bytes_of_text(const pybind11::handle& text);
std::vector<std::string> bytes_of_texts(const pybind11::handle& all);

}  // namespace pcednet::python
