#include <fmt/format.h>

#include <cstdlib>

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/host/kept_row_json.hpp"

namespace selvedge {
namespace {


}  // namespace

std::string cell_record_json(const CellRecord& record) {
  Json json = {{"cell", record.cell}, {"kind", record.kind},       {"program", record.program},
               {"key", record.key},   {"machine", record.machine}, {"passed", record.result.passed}};
  if (record.result.positions != 0) json["positions_hash"] = fmt::format("{:016x}", record.result.positions);
  json["row"] = parse_json(record.result.row);
  return json_text(json);
}

std::optional<CellRecord> read_cell_record(const std::string& text) {
  return read_row<CellRecord>(text, [](const Json& json, CellRecord& record) {
    json.at("cell").get_to(record.cell);
    json.at("kind").get_to(record.kind);
    json.at("program").get_to(record.program);
    json.at("key").get_to(record.key);
    json.at("machine").get_to(record.machine);
    json.at("passed").get_to(record.result.passed);
    if (json.contains("positions_hash"))
      record.result.positions =
          std::strtoull(json.at("positions_hash").get_ref<const std::string&>().c_str(), nullptr, 16);
    record.result.row = json_text(json.at("row").get_ref<const Json::object_t&>());
  });
}

}  // namespace selvedge
