// SPDX-License-Identifier: BSD-3-Clause
// The native module; people import python/ergocast/.
#include "python/module.h"

#include "runtime/process/program_options.h"

PYBIND11_MODULE(_native, module) {
  module.doc() = "The C++ part of the package ergocast.";
  module.attr("__version__") = ergocast::version();
  ergocast::python::add_method(module);
  ergocast::python::add_target(module);
  ergocast::python::add_team(module);
  ergocast::python::add_records(module);
  ergocast::python::add_own_laws(module);
}
