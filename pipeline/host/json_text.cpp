#include "pipeline/host/json_text.hpp"

namespace selvedge {

Json parse_json(const std::string& text) { return Json::parse(text); }
Json parse_json_or_discard(const std::string& text) { return Json::parse(text, nullptr, false); }

std::string json_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }
std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace selvedge
