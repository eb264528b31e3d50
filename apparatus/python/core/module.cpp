// _tremie: what tremie/__init__.py calls. Plain values in SI units in, dictionaries and arrays out.

#include <string>
#include <utility>
#include <vector>

#include "apparatus/python/core/parts.hpp"
#include "apparatus/report/fit_input.hpp"
#include "apparatus/scene/input_error.hpp"
#include "rheometer/records/torque_record.hpp"
#include "tremie_version.hpp"

namespace {

/// A message of the program with the arguments of run() and fit() for its options.
std::string in_python(std::string message) {
  std::vector<std::pair<std::string, std::string>> words{
      {"--set ", ""}, {"--force", "force=True"}, {"--out DIR", "out=DIR"}};
  for (const tremie::FitOption& option : tremie::fit_options())
    words.emplace_back(tremie::report::command_name(option), option.name);
  for (const auto& [option, argument] : words)
    for (std::size_t at = 0; (at = message.find(option, at)) != std::string::npos; at += argument.size())
      message.replace(at, option.size(), argument);
  return message;
}

}  // namespace

PYBIND11_MODULE(_tremie, module) {
  namespace py = pybind11;
  auto& input_error =
      py::register_exception<tremie::scene::InputError>(module, "InputError", PyExc_ValueError);
  input_error.attr("__module__") = "tremie";
  input_error.doc() = "Bad input: what is wrong, where, and what is allowed (the program's exit code 2).";
  py::register_exception_translator([](std::exception_ptr thrown) {
    const auto raise = [](const char* message) {
      PyErr_SetString(py::module_::import("tremie._tremie").attr("InputError").ptr(),
                      in_python(message).c_str());
    };
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const tremie::RecordError& error) {
      raise(error.what());
    } catch (const tremie::scene::InputError& error) {
      raise(error.what());
    }
  });
  module.attr("version") = tremie::version;
  module.attr("commit") = tremie::commit;
  tremie::python::add_scenes(module);
  tremie::python::add_rheometer(module);
}
