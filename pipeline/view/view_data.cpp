#include "pipeline/view/view_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "pipeline/formats/trajectory_row.hpp"
#include "pipeline/host/version.hpp"

namespace selvedge {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

constexpr int levels = 65535;
constexpr std::uint16_t not_finite = 65535;

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

// Writes base64, which has no character with a meaning in HTML.
void append_array(std::string& html, const std::string& id, std::string_view bytes) {
  html += "<script type=\"text/plain\" id=\"" + id + "\">" + base64(bytes) + "</script>\n";
}

void append_triangles(std::string& html, const std::string& id, const Triangles& triangles) {
  append_array(html, id, bytes_of(std::span<const int>(triangles.data(), triangles.size())));
}

// The boxes and arrays of one surface in the frames that are drawn.
struct Track {
  json boxes = json::array();
  std::vector<std::uint16_t> values;

  void append(const PointsF& x) {
    const QuantisedPoints q = quantise(x);
    boxes.push_back({q.origin.x(), q.origin.y(), q.origin.z(), q.step.x(), q.step.y(), q.step.z()});
    values.insert(values.end(), q.levels.begin(), q.levels.end());
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

std::size_t bytes_a_frame(const TrajectoryInfo& info) {
  std::size_t vertices = info.cloth_first_vertex.empty() ? info.rest.rows() : info.cloth_first_vertex.back();
  for (const auto& body : info.obstacles)
    if (body.moving) vertices += body.vertex_count;
  return vertices * 3 * sizeof(std::uint16_t) * 4 / 3;
}

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

json append_maps(std::string& html, const ViewRun& run, const std::string& id) {
  json maps = json::array();
  for (const ViewMap& map : run.maps) {
    append_array(html, id + "-map" + std::to_string(maps.size()), bytes_of(std::span<const float>(map.values)));
    maps.push_back({{"name", map.name}, {"unit", map.unit}, {"low", map.low}, {"high", map.high}});
  }
  return maps;
}

json append_run(std::string& html, const ViewRun& run, const std::string& id, std::size_t limit) {
  const TrajectoryInfo& info = run.info;
  const std::vector<int> drawn = drawn_frames(run.frame_count, bytes_a_frame(info), limit);
  Track cloth;
  std::vector<Track> bodies(info.obstacles.size());
  Series series;
  json marked = json::array();
  for (int index = 0, next = 0; index < run.frame_count; ++index) {
    const Frame frame = run.frame(index);
    series.append(frame);
    if (drawn[next] != index) continue;
    cloth.append(frame.x);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (index == 0 || info.obstacles[b].moving) bodies[b].append(frame.obstacles[b]);
    marked.push_back(frame.bad_triangles);
    next = std::min(next + 1, static_cast<int>(drawn.size()) - 1);
  }

  append_triangles(html, id + "-triangles", info.triangles);
  append_array(html, id + "-metric", bytes_of(std::span<const float>(inverse_rest_metric(info.rest_triangle))));
  append_array(html, id + "-x", bytes_of(std::span<const std::uint16_t>(cloth.values)));
  json j = describe(run);
  j["maps"] = append_maps(html, run, id);
  j["table"] = {{"titles", run.table.titles}, {"rows", run.table.rows}};
  j["drawn"] = drawn;
  j["boxes"] = cloth.boxes;
  j["marked"] = marked;
  j["series"] = series.numbers;
  j["obstacles"] = json::array();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& body = info.obstacles[b];
    const std::string body_id = id + "-body" + std::to_string(b);
    append_triangles(html, body_id + "-triangles", body.triangles);
    append_array(html, body_id + "-x", bytes_of(std::span<const std::uint16_t>(bodies[b].values)));
    j["obstacles"].push_back(
        {{"name", body.name}, {"moving", body.moving}, {"vertices", body.vertex_count}, {"boxes", bodies[b].boxes}});
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

QuantisedPoints quantise(const PointsF& x) {
  QuantisedPoints q;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (!x.row(i).allFinite()) continue;
    low = low.cwiseMin(x.row(i).transpose().cast<double>());
    high = high.cwiseMax(x.row(i).transpose().cast<double>());
  }
  if (low.allFinite()) {
    q.origin = low;
    q.step = (high - low) / (levels - 1);
  }
  q.levels.reserve(3 * x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (int k = 0; k < 3; ++k)
      q.levels.push_back(!x.row(i).allFinite() ? not_finite
                         : q.step[k] > 0 ? static_cast<std::uint16_t>(std::lround((x(i, k) - q.origin[k]) / q.step[k]))
                                         : 0);
  return q;
}

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

std::vector<int> drawn_frames(int frame_count, std::size_t bytes_a_frame, std::size_t limit) {
  const std::size_t fit = std::max<std::size_t>(2, bytes_a_frame > 0 ? limit / bytes_a_frame : frame_count);
  int stride = 1;
  const auto kept = [&] { return (frame_count - 1) / stride + 1 + ((frame_count - 1) % stride != 0); };
  while (static_cast<std::size_t>(kept()) > fit) ++stride;
  std::vector<int> drawn;
  for (int index = 0; index < frame_count; index += stride) drawn.push_back(index);
  if (frame_count > 0 && drawn.back() != frame_count - 1) drawn.push_back(frame_count - 1);
  return drawn;
}

std::string view_data(const std::vector<ViewRun>& runs, std::size_t limit) {
  std::string html;
  json all = {{"program", program_version()}, {"runs", json::array()}};
  for (std::size_t r = 0; r < runs.size(); ++r)
    all["runs"].push_back(append_run(html, runs[r], "run" + std::to_string(r), limit / runs.size()));
  html += "<script type=\"application/json\" id=\"runs\">" + script_json(all) + "</script>\n";
  return html;
}

}  // namespace selvedge
