// _tremie: what tremie/__init__.py calls. Plain values in SI units in, dictionaries and arrays out.

#include "apparatus/python/core/parts.hpp"
#include "apparatus/scene/input_error.hpp"
#include "rheometer/records/torque_record.hpp"
#include "tremie_version.hpp"

PYBIND11_MODULE(_tremie, module) {
  namespace py = pybind11;
  auto& input_error =
      py::register_exception<tremie::scene::InputError>(module, "InputError", PyExc_ValueError);
  input_error.attr("__module__") = "tremie";
  input_error.doc() = "Bad input: what is wrong, where, and what is allowed (the program's exit code 2).";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const tremie::RecordError& error) {
      PyErr_SetString(py::module_::import("tremie._tremie").attr("InputError").ptr(), error.what());
    }
  });
  module.attr("version") = tremie::version;
  module.attr("commit") = tremie::commit;
  tremie::python::add_scenes(module);
  tremie::python::add_rheometer(module);
}
