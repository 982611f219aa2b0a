#include "text.h"

namespace pcednet::python {
namespace {

constexpr const char* kOtherBytes = "surrogateescape";

}  // namespace

pybind11::str text_of(std::string_view bytes) {
  PyObject* text =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), kOtherBytes);
  if (!text) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(text);
}

pybind11::list texts_of(const std::vector<std::string>& all) {
  pybind11::list texts;
  for (const std::string& one : all) texts.append(text_of(one));
  return texts;
}

std::string bytes_of_text(const pybind11::handle& text) {
  PyObject* bytes = PyUnicode_AsEncodedString(text.ptr(), "utf-8", kOtherBytes);
  if (!bytes) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::bytes>(bytes);
}

std::vector<std::string> bytes_of_texts(const pybind11::handle& all) {
  std::vector<std::string> bytes;
  for (const pybind11::handle one : all) bytes.push_back(bytes_of_text(one));
  return bytes;
}

}  // namespace pcednet::python
