#include "app/python/bindings.h"
#include "core/base/error.h"

NB_MODULE(_nearfit, module) {
  namespace python = nearfit::python;
  module.doc() =
      "Minima, distances, overlaps and placements of rigid meshes. Lengths in metres, angles in radians; "
      "poses are world "
      "from part.";
  module.attr("__version__") = NEARFIT_VERSION;
  const python::nb::exception<nearfit::Error> error(module, "Error", PyExc_RuntimeError);
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
