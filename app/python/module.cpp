#include <exception>
#include <string_view>

#include "app/python/bindings.h"
#include "core/base/error.h"

namespace nearfit::python {
namespace {

/// Raises `type` with the words of an Error. They may name a file whose name is not UTF-8: its bytes stay as os.fsdecode()
/// has them, where PyErr_SetString() would lose the whole message.
void raiseError(const std::exception_ptr& thrown, void* type) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& e) {
    const std::string_view words = e.what();
    const auto text = nb::steal<nb::object>(
        PyUnicode_DecodeUTF8(words.data(), static_cast<Py_ssize_t>(words.size()), "surrogateescape"));
    // Without it there is another exception already, as for lack of memory.
    if (text.is_valid()) PyErr_SetObject(static_cast<PyObject*>(type), text.ptr());
  }
}

}  // namespace
}  // namespace nearfit::python

NB_MODULE(_nearfit, module) {
  namespace python = nearfit::python;
  module.doc() =
      "Minima, distances, overlaps and placements of rigid meshes. Lengths in metres, angles in radians; "
      "poses are world "
      "from part.";
  module.attr("__version__") = NEARFIT_VERSION;
  const python::nb::exception<nearfit::Error> error(module, "Error", PyExc_RuntimeError);
  // Asked before that of nb::exception, as the later one.
  python::nb::register_exception_translator(&python::raiseError, error.ptr());
  error.attr("__doc__") =
      "An error with its place, the problem and a remedy, in the words of the command line.";
  python::bindMesh(module);
  python::bindScene(module);
  python::bindQueries(module);
  python::bindClearance(module);
  python::bindPlacing(module);
  python::bindCertificates(module);
  python::bindExports(module);
}
