#include "pipeline/compare/compare_parts.hpp"

#include "pipeline/host/kept_row_json.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

double number_or_unknown(const Json& value) { return value.is_number() ? value.get<double>() : unknown; }

Json numbers_of(const std::map<std::string, double>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = number_or_null(value);
  return json;
}

std::map<std::string, double> numbers_from(const Json& json) {
  std::map<std::string, double> values;
  for (const auto& [name, value] : json.items()) values[name] = number_or_unknown(value);
  return values;
}

constexpr auto floor_fields = [](auto& f, const auto& visit) {
  visit("scene", f.scene);
  visit("vertices", f.vertices);
  visit("frames", f.frames);
  visit("states", f.states);
  visit("horizon", f.horizon);
  visit("motion", f.motion);
  visit("steps", f.steps);
  visit("jittered", f.jittered);
  visit("lost", f.lost);
};

}  // namespace

std::string part_json(const CompareFloor& f, const std::string& key) {
  return kept_row_json(row_to_json(f, floor_fields), key);
}

std::optional<CompareFloor> read_floor(const std::string& text, const std::string& key) {
  return read_kept_row<CompareFloor>(text, key,
                                     [](const Json& json, CompareFloor& f) { row_from_json(json, floor_fields, f); });
}

std::string part_json(const CompareErrors& e, const std::string& key) {
  return kept_row_json({{"trouble", e.trouble},
                        {"algebraic", number_or_null(e.algebraic)},
                        {"algebraic_largest", number_or_null(e.algebraic_largest)},
                        {"temporal", number_or_null(e.temporal)},
                        {"measures", numbers_of(e.measures)}},
                       key);
}

std::optional<CompareErrors> read_errors(const std::string& text, const std::string& key) {
  return read_kept_row<CompareErrors>(text, key, [](const Json& j, CompareErrors& e) {
    j.at("trouble").get_to(e.trouble);
    e.algebraic = number_or_unknown(j.at("algebraic"));
    e.algebraic_largest = number_or_unknown(j.at("algebraic_largest"));
    e.temporal = number_or_unknown(j.at("temporal"));
    e.measures = numbers_from(j.at("measures"));
  });
}

std::string part_json(const CompareRun& r, const std::string& key) {
  return kept_row_json({{"trouble", r.trouble},
                        {"seconds", r.seconds},
                        {"substeps", r.substeps},
                        {"newton", r.newton},
                        {"linear", r.linear},
                        {"passed_through", r.passed_through},
                        {"pairs", r.pairs},
                        {"lost", number_or_null(r.lost)},
                        {"end", r.end},
                        {"measures", numbers_of(r.measures)},
                        {"phases", numbers_of(r.phases)},
                        {"pairs_by_frame", r.pairs_by_frame}},
                       key);
}

std::optional<CompareRun> read_run(const std::string& text, const std::string& key) {
  return read_kept_row<CompareRun>(text, key, [](const Json& j, CompareRun& r) {
    j.at("trouble").get_to(r.trouble);
    j.at("seconds").get_to(r.seconds);
    j.at("substeps").get_to(r.substeps);
    j.at("newton").get_to(r.newton);
    j.at("linear").get_to(r.linear);
    j.at("passed_through").get_to(r.passed_through);
    j.at("pairs").get_to(r.pairs);
    r.lost = number_or_unknown(j.at("lost"));
    j.at("end").get_to(r.end);
    r.measures = numbers_from(j.at("measures"));
    r.phases = numbers_from(j.at("phases"));
    j.at("pairs_by_frame").get_to(r.pairs_by_frame);
  });
}

}  // namespace selvedge
