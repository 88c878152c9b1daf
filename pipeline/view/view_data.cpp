#include "pipeline/view/view_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/trajectory_row.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/view/packed_positions.hpp"

namespace selvedge {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

// Arrays in base64, which has no character with a meaning in HTML. Equal ones, such as a body's in several runs, stand
// in the page once.
struct Arrays {
  std::string html;
  std::map<std::string, std::string, std::less<>> known;  // text -> id

  std::string add(std::string_view bytes) {
    std::string text = base64(bytes);
    const auto [at, is_new] = known.try_emplace(std::move(text), "array" + std::to_string(known.size()));
    if (is_new) html += "<script type=\"text/plain\" id=\"" + at->second + "\">" + at->first + "</script>\n";
    return at->second;
  }
};

// All values that are plotted or written beside the picture, by field name, for every frame.
struct Series {
  json numbers = json::object();

  void append(const Frame& frame) {
    for (const BoundField<Frame>& field : frame_fields())
      if (field.page == Page::yes)
        std::visit([&](const auto& value) { numbers[field.name].push_back(value); }, field.get(frame));
  }
};

json describe(const ViewRun& run) {
  const TrajectoryInfo& info = run.info;
  json doubts = json::array();
  for (const BoundField<Doubts>& doubt : doubt_fields()) doubts.push_back(doubt.name);
  return {{"name", run.name},
          {"doubts", doubts},
          {"stepper", info.stepper},
          {"program", info.program_version},
          {"fps", info.fps},
          {"selfAudited", info.self_audited},
          {"vertices", info.rest.rows()},
          {"triangles", info.triangles.rows()},
          {"pins", info.pins},
          {"clothNames", info.cloth_names},
          {"clothFirstTriangle", info.cloth_first_triangle}};
}

// The pressure in each drawn frame, in bytes: 0 to 254 from 0 to the top, which 98 of 100 pressed vertices stay under,
// and 255 where it is not known.
json pressure_map(Arrays& arrays, const std::vector<Eigen::VectorXd>& pressures) {
  std::vector<double> pressed;
  for (const Eigen::VectorXd& frame : pressures)
    for (const double value : frame)
      if (value > 0) pressed.push_back(value);
  const auto high = pressed.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(pressed.size()));
  std::nth_element(pressed.begin(), high, pressed.end());
  const double top = pressed.empty() ? 1 : *high;
  std::vector<std::uint8_t> levels;
  for (const Eigen::VectorXd& frame : pressures)
    for (const double value : frame)
      levels.push_back(std::isfinite(value)
                           ? static_cast<std::uint8_t>(std::lround(254 * std::clamp(value / top, 0.0, 1.0)))
                           : std::uint8_t{255});
  return {{"name", "pressure"}, {"unit", "Pa"},    {"low", 0},
          {"high", top},        {"changes", true}, {"values", arrays.add(bytes_of(levels))}};
}

json append_maps(Arrays& arrays, const ViewRun& run, const std::vector<Eigen::VectorXd>& pressures) {
  json maps = json::array();
  for (const ViewMap& map : run.maps)
    maps.push_back({{"name", map.name},
                    {"unit", map.unit},
                    {"low", map.low},
                    {"high", map.high},
                    {"changes", false},
                    {"values", arrays.add(bytes_of(map.values))}});
  if (!pressures.empty()) maps.push_back(pressure_map(arrays, pressures));
  return maps;
}

// What is drawn of a run: the frames, positions in them, marked triangles.
struct Drawn {
  std::vector<int> frames;
  PackedPositions cloth;
  std::vector<PackedPositions> bodies;
  json marked = json::array();
  std::vector<Eigen::VectorXd> pressures;  // none without contact forces

  void append(const TrajectoryInfo& info, int index, const Frame& frame) {
    if (frames.empty()) {
      cloth.step = grid_step(frame.x);
      bodies.resize(info.obstacles.size());
      for (std::size_t b = 0; b < bodies.size(); ++b) bodies[b].step = grid_step(frame.obstacles[b]);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (frames.empty() || info.obstacles[b].moving) selvedge::append(bodies[b], frame.obstacles[b]);
    selvedge::append(cloth, frame.x);
    frames.push_back(index);
    marked.push_back(frame.bad_triangles);
    if (info.contact_forces) pressures.push_back(frame.report.contact_forces->pressure);
  }
  std::size_t text_bytes() const {
    std::size_t sum = cloth.bytes.size();
    for (const PackedPositions& body : bodies) sum += body.bytes.size();
    for (const Eigen::VectorXd& frame : pressures) sum += static_cast<std::size_t>(frame.size());
    return sum * 4 / 3;
  }
};

// The first frames of `wanted` that the limit has room for, and two of them at least.
Drawn drawn_of(const ViewRun& run, const std::vector<int>& wanted, std::size_t limit) {
  Drawn drawn;
  for (std::size_t k = 0; k < wanted.size() && (wanted.size() <= 2 || drawn.text_bytes() <= limit); ++k)
    drawn.append(run.info, wanted[k], run.frame(wanted[k]));
  return drawn;
}

// Every k-th frame and the last, with a k for which their text is within the limit.
Drawn drawn_within(const ViewRun& run, std::size_t limit) {
  for (int stride = 1;;) {
    const std::vector<int> wanted = drawn_frames(run.frame_count, stride);
    Drawn drawn = drawn_of(run, wanted, limit);
    if (wanted.size() <= 2 || (drawn.frames.size() == wanted.size() && drawn.text_bytes() <= limit)) return drawn;
    const double fit = static_cast<double>(drawn.frames.size()) / static_cast<double>(wanted.size());
    stride = std::max(stride + 1, static_cast<int>(stride / fit));
  }
}

json describe(Arrays& arrays, const PackedPositions& packed) {
  json absent = json::object();
  for (std::size_t f = 0; f < packed.absent.size(); ++f)
    if (!packed.absent[f].empty()) absent[std::to_string(f)] = packed.absent[f];
  return {{"step", packed.step}, {"frames", packed.frames}, {"absent", absent}, {"bytes", arrays.add(closed(packed))}};
}

json append_run(Arrays& arrays, const ViewRun& run, std::size_t limit) {
  const TrajectoryInfo& info = run.info;
  Series series;
  for (int index = 0; index < run.frame_count; ++index) series.append(run.frame(index));
  const Drawn drawn = drawn_within(run, limit);
  json j = describe(run);
  j["triangleArray"] = arrays.add(bytes_of(info.triangles));
  j["metric"] = arrays.add(bytes_of(inverse_rest_metric(info.rest_triangle)));
  j["positions"] = describe(arrays, drawn.cloth);
  j["maps"] = append_maps(arrays, run, drawn.pressures);
  j["table"] = {{"titles", run.table.titles}, {"rows", run.table.rows}};
  j["drawn"] = drawn.frames;
  j["marked"] = drawn.marked;
  j["series"] = series.numbers;
  j["obstacles"] = json::array();
  for (std::size_t b = 0; b < drawn.bodies.size(); ++b) {
    const auto& body = info.obstacles[b];
    j["obstacles"].push_back({{"name", body.name},
                              {"moving", body.moving},
                              {"vertices", body.vertex_count},
                              {"triangleArray", arrays.add(bytes_of(body.triangles))},
                              {"positions", describe(arrays, drawn.bodies[b])}});
  }
  return j;
}

// JSON for a script element. Only '<' could end the element, so that it is escaped.
std::string script_json(const json& j) {
  std::string text;
  for (const char c : j.dump(-1, ' ', true, json::error_handler_t::replace)) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace

std::vector<float> inverse_rest_metric(const std::vector<RestTriangle>& rest) {
  std::vector<float> h;
  h.reserve(3 * rest.size());
  for (const RestTriangle& r : rest) {
    const Vec2 e = r.col(1) - r.col(0), f = r.col(2) - r.col(0);
    const double twice_area = e.x() * f.y() - e.y() * f.x(), determinant = twice_area * twice_area;
    const double s = determinant > 0 ? 1 / determinant : 0;
    for (const double value : {f.dot(f), -e.dot(f), e.dot(e)}) h.push_back(static_cast<float>(s * value));
  }
  return h;
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < present ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= present ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::vector<int> drawn_frames(int frame_count, int stride) {
  std::vector<int> drawn;
  for (int index = 0; index < frame_count; index += stride) drawn.push_back(index);
  if (frame_count > 0 && drawn.back() != frame_count - 1) drawn.push_back(frame_count - 1);
  return drawn;
}

std::string view_data(const std::vector<ViewRun>& runs, std::size_t limit) {
  Arrays arrays;
  json all = {{"program", program_version()}, {"runs", json::array()}};
  for (const ViewRun& run : runs) all["runs"].push_back(append_run(arrays, run, limit / runs.size()));
  return arrays.html + "<script type=\"application/json\" id=\"runs\">" + script_json(all) + "</script>\n";
}

}  // namespace selvedge
