#include "pipeline/motions/clip_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

struct Token {
  std::string text;
  int line = 0;
};

struct Reader {
  std::string name;
  std::vector<Token> tokens;
  std::size_t next = 0;

  [[noreturn]] void fail(int line, const std::string& what, const std::string& cure) const {
    throw Error(what, fmt::format("{}:{}", name, line), cure);
  }
  bool ends() const { return next >= tokens.size(); }
  int line() const { return tokens.empty() ? 1 : tokens[std::min(next, tokens.size() - 1)].line; }
  const Token& take(const std::string& wanted) {
    if (ends()) fail(line(), "ends where " + wanted + " should come", "get the whole file");
    return tokens[next++];
  }
  void expect(const std::string& word) {
    const Token& token = take("`" + word + "`");
    if (token.text != word)
      fail(token.line, fmt::format("has `{}` where `{}` should come", token.text, word), "is it a BVH file?");
  }
  double number(const std::string& of) {
    const Token& token = take(of);
    const std::optional<double> value = read_number(token.text);
    if (!value || !std::isfinite(*value))
      fail(token.line, fmt::format("`{}` is no finite number, {} should come", token.text, of), "repair the file");
    return *value;
  }
  // An offset or a number of the motion. A rig of any unit is smaller than this.
  double bounded(const std::string& of) {
    constexpr double most = 1e9;
    const int at = line();
    const double value = number(of);
    if (std::abs(value) > most)
      fail(at, fmt::format("{} is {:g}", of, value), fmt::format("up to {:g} is allowed", most));
    return value;
  }
  int count(const std::string& of, int most) {
    const int at = line();
    const double value = number(of);
    if (value < 0 || value > most || value != std::floor(value))
      fail(at, fmt::format("{} is {}", of, value), fmt::format("a whole number from 0 to {}", most));
    return static_cast<int>(value);
  }
};

// Splits the text into words with their line numbers; braces are words of their own.
std::vector<Token> split(std::string_view text) {
  std::vector<Token> tokens;
  int line = 1;
  bool open = false;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\t' || c == '\r' || c == '\n';
    const bool brace = c == '{' || c == '}';
    if (space || brace) open = false;
    if (brace) tokens.push_back({std::string(1, c), line});
    if (!space && !brace) {
      if (!open) tokens.push_back({"", line});
      tokens.back().text += c;
      open = true;
    }
    if (c == '\n') ++line;
  }
  return tokens;
}

BvhChannel channel(const Reader& r, const Token& token) {
  static const std::vector<std::string> names = {"Xposition", "Yposition", "Zposition",
                                                 "Xrotation", "Yrotation", "Zrotation"};
  const auto found = std::find(names.begin(), names.end(), token.text);
  if (found == names.end())
    r.fail(token.line, fmt::format("`{}` is no channel", token.text),
           "channels: " + joined(names) + suggestion(token.text, names));
  return static_cast<BvhChannel>(found - names.begin());
}

Vec3 read_offset(Reader& r) {
  r.expect("OFFSET");
  Vec3 offset;
  for (int k = 0; k < 3; ++k) offset[k] = r.bounded("a coordinate of an offset");
  return offset;
}

void read_channels(Reader& r, BvhJoint& joint) {
  r.expect("CHANNELS");
  const int count = r.count("the number of channels", 6);
  for (int k = 0; k < count; ++k) joint.channels.push_back(channel(r, r.take("a channel")));
  const std::set<BvhChannel> different(joint.channels.begin(), joint.channels.end());
  if (different.size() != joint.channels.size()) r.fail(r.line(), "has a channel twice", "repair the file");
}

// A joint's name may have spaces in it.
std::string read_name(Reader& r) {
  std::string name = r.take("a joint's name").text;
  while (!r.ends() && r.tokens[r.next].text != "{") name += " " + r.tokens[r.next++].text;
  r.expect("{");
  return name;
}

std::vector<BvhJoint> read_hierarchy(Reader& r) {
  std::vector<BvhJoint> joints;
  std::vector<int> open;
  std::set<std::string> names;
  int channels = 0;
  do {
    const Token word = r.take("`JOINT` or `}`");
    if (word.text == (joints.empty() ? "ROOT" : "JOINT")) {
      BvhJoint joint{read_name(r), open.empty() ? -1 : open.back(), {}, {}, channels};
      if (!names.insert(joint.name).second)
        r.fail(word.line, fmt::format("has a second joint `{}`", joint.name), "give joints names of their own");
      joint.offset = read_offset(r);
      read_channels(r, joint);
      channels += static_cast<int>(joint.channels.size());
      open.push_back(static_cast<int>(joints.size()));
      joints.push_back(std::move(joint));
    } else if (word.text == "End" && !joints.empty()) {
      r.expect("Site");
      r.expect("{");
      read_offset(r);
      r.expect("}");
    } else if (word.text == "}" && !open.empty()) {
      open.pop_back();
    } else {
      r.fail(word.line, fmt::format("has `{}` in the hierarchy", word.text), "is it a BVH file with one ROOT?");
    }
  } while (!open.empty());
  return joints;
}

void read_motion(Reader& r, BvhFile& bvh) {
  int columns = 0;
  for (const BvhJoint& joint : bvh.joints) columns += static_cast<int>(joint.channels.size());
  r.expect("MOTION");
  r.expect("Frames:");
  const int frames = r.count("the number of frames", 100'000'000);
  r.expect("Frame");
  r.expect("Time:");
  const int time_line = r.line();
  const double seconds = r.number("the time of a frame");
  constexpr double longest = 1;  // what is longer is mostly meant in milliseconds
  if (!(seconds >= 1e-6 && seconds <= longest))
    r.fail(time_line, fmt::format("the time of a frame is {:g}", seconds), "give seconds, from 1e-6 to 1");
  bvh.fps = 1 / seconds;
  if (std::abs(bvh.fps / std::round(bvh.fps) - 1) < 2e-4) bvh.fps = std::round(bvh.fps);  // 0.041667 is 24
  const std::size_t left = r.tokens.size() - r.next,
                    wanted = static_cast<std::size_t>(frames) * static_cast<std::size_t>(columns);
  if (frames == 0) r.fail(time_line, "has no frames", "export the motion with its frames");
  if (columns == 0) r.fail(time_line, "has no channels", "export the motion with its joints' channels");
  if (left != wanted)
    r.fail(r.tokens.back().line,
           fmt::format("has {} numbers of motion, {} frames of {} channels need {}", left, frames, columns, wanted),
           "get the whole file");
  bvh.motion.resize(frames, columns);
  for (int f = 0; f < frames; ++f)
    for (int c = 0; c < columns; ++c) bvh.motion(f, c) = r.bounded("a number of the motion");
}

// Where the position channels of a joint count from.
Vec3 channels_from(const BvhFile& bvh, const BvhJoint& joint) {
  if (joint.parent < 0 || bvh.motion.rows() == 0) return joint.offset;
  Vec3 first = Vec3::Zero();
  int count = 0;
  for (std::size_t c = 0; c < joint.channels.size(); ++c)
    if (const int kind = static_cast<int>(joint.channels[c]); kind < 3) {
      first[kind] = bvh.motion(0, joint.first_channel + static_cast<int>(c));
      ++count;
    }
  const bool whole = count == 3 && (first - joint.offset).norm() < 0.5 * joint.offset.norm();
  return whole ? Vec3::Zero() : joint.offset;
}

}  // namespace

BvhFile parse_bvh(std::string_view text, const std::string& name) {
  Reader r{name, split(text)};
  BvhFile bvh;
  bvh.file = name;
  r.expect("HIERARCHY");
  bvh.joints = read_hierarchy(r);
  read_motion(r, bvh);
  return bvh;
}

BvhFile read_bvh(const std::filesystem::path& path) { return parse_bvh(read_text_file(path, "BVH"), path.string()); }

BvhPose bvh_pose(const BvhFile& bvh, int frame, int pelvis) {
  BvhPose pose;
  std::vector<char> travels(bvh.joints.size(), 0);
  for (std::size_t j = 0; j < travels.size(); ++j) travels[j] = bvh.joints[j].parent < 0;
  for (int j = pelvis; j >= 0; j = bvh.joints[static_cast<std::size_t>(j)].parent)
    travels[static_cast<std::size_t>(j)] = 1;
  pose.positions.resize(static_cast<Eigen::Index>(bvh.joints.size()), 3);
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const BvhJoint& joint = bvh.joints[j];
    Mat3 turn = Mat3::Identity();
    Vec3 moved = frame >= 0 && travels[j] ? channels_from(bvh, joint) : joint.offset;
    for (std::size_t c = 0; c < joint.channels.size() && frame >= 0; ++c) {
      const int kind = static_cast<int>(joint.channels[c]);
      const double value = bvh.motion(frame, joint.first_channel + static_cast<int>(c));
      // Channels from left to right are rotations from the outside in.
      if (kind >= 3) turn = turn * rotation_matrix(value * std::numbers::pi / 180 * Vec3::Unit(kind - 3));
      if (kind < 3 && travels[j]) moved[kind] += value;
    }
    if (joint.parent >= 0) {
      const Mat3& parent = pose.rotations[joint.parent];
      moved = row(pose.positions, joint.parent) + parent * moved;
      turn = parent * turn;
    }
    pose.rotations.push_back(turn);
    pose.positions.row(static_cast<Eigen::Index>(j)) = moved.transpose();
  }
  return pose;
}

}  // namespace selvedge
