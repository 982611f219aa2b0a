#include <pybind11/pybind11.h>

#include "bindings.h"
#include "pcednet/core/error.h"
#include "pcednet/core/exists_already.h"
#include "text.h"

namespace pcednet::python {
namespace {

namespace py = pybind11;

/// The class of pcednet/errors.py for an error.
const char* class_of(const Error& error) {
  if (dynamic_cast<const ExistsAlready*>(&error) != nullptr) return "ExistsError";
  switch (error.kind()) {
    case ErrorKind::kUsage:
      return "UsageError";
    case ErrorKind::kUnreadable:
      return "UnreadableError";
    case ErrorKind::kInsufficient:
      return "InsufficientError";
    case ErrorKind::kModelMismatch:
      return "ModelError";
    case ErrorKind::kFailure:
    case ErrorKind::kCancelled:
      break;
  }
  return "FailureError";
}

}  // namespace

void add_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const py::object type = py::module_::import("pcednet.errors").attr(class_of(error));
      PyErr_SetObject(type.ptr(), text_of(error.what()).ptr());
    }
  });
}

}  // namespace pcednet::python
