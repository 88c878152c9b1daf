#include "pipeline/config/options.hpp"

namespace selvedge {
namespace {

void put_number(double value, Config& entry) {
  entry.numbers = {value};
  entry.words.clear();
}

}  // namespace

void take(const Config& entry, double& value) { value = entry.number(); }
void take(const Config& entry, int& value) { value = entry.integer(); }
void take(const Config& entry, std::uint64_t& value) { value = static_cast<std::uint64_t>(entry.number()); }
void take(const Config& entry, bool& value) { value = entry.flag(); }
void take(const Config& entry, std::string& value) { value = entry.text(); }
void take(const Config& entry, Vec3& value) { value = entry.vector(); }
void take(const Config& entry, std::vector<double>& value) { value = entry.numbers; }
void take(const Config& entry, std::vector<std::string>& value) { value = entry.words; }

void put(double value, Config& entry) { put_number(value, entry); }
void put(int value, Config& entry) { put_number(value, entry); }
void put(std::uint64_t value, Config& entry) { put_number(static_cast<double>(value), entry); }
void put(bool value, Config& entry) { put_number(value ? 1 : 0, entry); }
void put(const Vec3& value, Config& entry) { entry.numbers = {value.x(), value.y(), value.z()}; }
void put(const std::vector<double>& value, Config& entry) { entry.numbers = value; }
void put(const std::vector<std::string>& value, Config& entry) { entry.words = value; }
void put(const std::string& value, Config& entry) {
  entry.words.clear();
  if (!value.empty()) entry.words = {value};
}

std::string default_text(const Config& entry) {
  std::vector<std::string> values = entry.words;
  for (const double number : entry.numbers)
    values.push_back(entry.key->kind == Kind::boolean ? table::show(number != 0) : table::show(number));
  return names_of(entry.key->kind).list && !values.empty() ? "[" + joined(values) + "]" : joined(values);
}

Config empty_section(const Section& section) {
  Config config;
  config.section = &section;
  config.given = true;
  for (const Key& key : section.keys) {
    Config& entry = config.entries.emplace_back();
    if (key.kind == Kind::section) entry = empty_section(*key.section);
    entry.key = &key;
  }
  return config;
}

}  // namespace selvedge
