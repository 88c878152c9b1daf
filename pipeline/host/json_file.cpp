#include "pipeline/host/json_file.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

std::string place_of(const std::string& text, const std::string& file, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return file + ":" + std::to_string(1 + std::count(text.begin(), end, '\n'));
}

// Where the key of this number begins, counted from 0 through the whole text: a key is a text before a colon.
std::size_t begin_of_key(const std::string& text, int number) {
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 1)) {
    const std::size_t begin = at++;
    while (text[at] != '"') at += text[at] == '\\' ? 2 : 1;
    const std::size_t next = text.find_first_not_of(" \t\r\n", at + 1);
    if (next != std::string::npos && text[next] == ':' && number-- == 0) return begin;
  }
  return text.size();
}

struct RepeatedKey {
  std::string name;
  int number;  // of the key, among all of the text
};

// Throws RepeatedKey.
Json parsed_with_single_keys(const std::string& text) {
  std::vector<std::set<std::string>> open;  // keys of the objects that are being read, the innermost last
  int keys = 0;
  const Json::parser_callback_t see = [&](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event != Json::parse_event_t::key) return true;
    if (!open.back().insert(value.get<std::string>()).second) throw RepeatedKey{value.get<std::string>(), keys};
    ++keys;
    return true;
  };
  return Json::parse(text, see);
}

}  // namespace

Json json_of_file(const std::string& text, const std::string& file) {
  try {
    return parsed_with_single_keys(text);
  } catch (const RepeatedKey& key) {
    throw Error("`" + key.name + "` is given twice", place_of(text, file, begin_of_key(text, key.number)),
                "keep one of them");
  } catch (const Json::parse_error& problem) {
    throw Error("is no JSON", place_of(text, file, problem.byte), "repair the line or what stands before it");
  } catch (const Json::out_of_range&) {
    throw Error("has a number that is too large", file, "repair the file where it was made");
  }
}

}  // namespace selvedge
