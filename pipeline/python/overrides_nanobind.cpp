#include "pipeline/python/overrides_nanobind.hpp"

#include <nanobind/stl/string.h>

#include "collision/geometry/error.hpp"
#include "pipeline/python/arrays_nanobind.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

void add_values(const nb::dict& values, const std::string& above, std::vector<std::string>& texts) {
  for (const auto& [name, value] : values) {
    const std::string key = above + nb::str(name).c_str();
    if (nb::isinstance<nb::dict>(value))
      add_values(nb::cast<nb::dict>(value), key + ".", texts);
    else
      texts.push_back(key + "=" + yaml_of(value, "overrides, " + key));
  }
}

}  // namespace

std::string yaml_of(const nb::handle& value, const std::string& where) {
  try {
    const nb::object plain = nb::module_::import_("operator").attr("methodcaller")("tolist");  // of numpy's numbers
    return nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(value, "default"_a = plain));
  } catch (const nb::python_error& error) {
    throw Error(std::string("holds what a scene file cannot say: ") + nb::str(error.value()).c_str(), where,
                "give numbers, texts, lists and dictionaries");
  }
}

std::vector<std::string> overrides_of(const nb::handle& overrides) {
  const std::string cure = "give a list, [\"run.frames=60\"], or a dict, {\"run.frames\": 60}";
  std::vector<std::string> texts;
  if (nb::isinstance<nb::dict>(overrides)) {
    add_values(nb::cast<nb::dict>(overrides), "", texts);
    return texts;
  }
  if (nb::isinstance<nb::str>(overrides)) throw Error("is one text", "overrides", cure);
  for (const nb::handle one : list_of(overrides, "overrides", cure)) {
    if (!nb::isinstance<nb::str>(one)) throw Error("holds what is no text", "overrides", cure);
    texts.push_back(nb::cast<std::string>(one));
  }
  return texts;
}

}  // namespace selvedge
