#include <algorithm>
#include <cctype>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/motions/clip_bvh.hpp"

namespace selvedge {
namespace {

// The names in rigs of the joints of a limb or the trunk, in the order of SMPL's names; empty: the rig lacks it. In
// lower case without punctuation; # stands for left or right, $ for l or r.
struct Chain {
  std::vector<std::string> smpl;
  std::vector<std::vector<std::string>> rigs;
};

const std::vector<Chain>& chains() {
  static const std::vector<Chain> table = {
      {{"spine1", "spine2", "spine3"},
       {{"spine1", "spine2", "spine3"},        // SMPL, MakeHuman's BVH
        {"spine05", "spine03", "spine01"},     // MakeHuman
        {"lowerback", "spine", "spine1"},      // CMU
        {"spine", "spine1", "spine2"},         // Mixamo, LAFAN, Biped
        {"spine01", "spine02", "spine03"},     // Unreal
        {"waist", "spine01", "spine02"},       // Reallusion
        {"spine001", "spine002", "spine003"},  // Rigify
        {"l5", "t12", "t8"},                   // Xsens
        {"l5", "l3", "t8"},
        {"spine", "chest", "upperchest"},                // Blender, Unity
        {"abdomenlower", "abdomenupper", "chestlower"},  // Daz
        {"spinebase", "spinemid", "spineshoulder"},      // Kinect
        {"abdomen", "chest", ""},                        // Poser
        {"spine", "", "spine1"},
        {"ab", "chest", ""},  // Motive
        {"chest", "chest2", "chest3"}}},
      {{"neck", "head"},
       {{"neck", "head"},
        {"neck1", "head"},
        {"neck01", "head"},
        {"neck02", "head"},
        {"necklower", "head"},
        {"necktwist01", "head"},
        {"spine004", "spine006"},
        {"spine005", "spine006"}}},
      {{"#_collar", "#_shoulder", "#_elbow", "#_wrist", "#_hand"},
       {{"#collar", "#shoulder", "#elbow", "#wrist", "#hand"},      // SMPL
        {"#shoulder", "#arm", "#forearm", "#hand", ""},             // CMU, Mixamo, LAFAN
        {"clavicle$", "uparm$", "loarm$", "hand$", ""},             // MakeHuman's BVH
        {"clavicle$", "upperarm01$", "lowerarm01$", "wrist$", ""},  // MakeHuman
        {"clavicle$", "upperarm$", "lowerarm$", "hand$", ""},       // Unreal
        {"shoulder$", "upperarm$", "forearm$", "hand$", ""},        // Blender
        {"$clavicle", "$upperarm", "$forearm", "$hand", ""},        // Biped
        {"$clavicle", "$humerus", "$radius", "$wrist", "$hand"},    // Acclaim
        {"$collar", "$shldr", "$forearm", "$hand", ""},             // Poser
        {"$collar", "$shoulder", "$elbow", "$wrist", "$hand"},
        {"shoulder$", "upperarm$", "lowerarm$", "hand$", ""},  // Bandai Namco
        {"$shoulder", "$upperarm", "$lowerarm", "$hand", ""},  // VRM
        {"$shoulder", "$upperarm", "$forearm", "$hand", ""},   // Daz
        {"$collar", "$shldrbend", "$forearmbend", "$hand", ""},
        {"#shoulder", "#upperarm", "#forearm", "#hand", ""},  // Xsens
        {"$shoulder", "$uarm", "$farm", "$hand", ""},         // Motive
        {"#shoulder", "#arm", "#elbow", "#wrist", ""},        // VRChat
        {"", "shoulder#", "elbow#", "wrist#", "hand#"},       // Kinect
        {"#collar", "#uparm", "#lowarm", "#hand", ""},
        {"#shoulder", "#upperarm", "#lowerarm", "#hand", ""}}},
      {{"#_hip", "#_knee", "#_ankle", "#_foot"},
       {{"#hip", "#knee", "#ankle", "#foot"},               // SMPL
        {"#upleg", "#leg", "#foot", "#toebase"},            // CMU, Mixamo
        {"#upleg", "#leg", "#foot", "#toe"},                // LAFAN
        {"#upleg", "#leg", "#foot", "#footend"},            // Perception Neuron
        {"upleg$", "loleg$", "foot$", "toe$"},              // MakeHuman's BVH
        {"upperleg01$", "lowerleg01$", "foot$", "toe11$"},  // MakeHuman
        {"thigh$", "calf$", "foot$", "ball$"},              // Unreal
        {"thigh$", "shin$", "foot$", "toe$"},               // Blender
        {"$thigh", "$calf", "$foot", "$toe0"},              // Biped
        {"$femur", "$tibia", "$foot", "$toes"},             // Acclaim
        {"$thigh", "$shin", "$foot", "$toe"},               // Poser
        {"upperleg$", "lowerleg$", "foot$", "toes$"},       // Bandai Namco
        {"$upperleg", "$lowerleg", "$foot", "$toebase"},    // VRM
        {"$thigh", "$calf", "$foot", "$toebase"},           // Reallusion
        {"$thigh", "$shin", "$foot", "$toes"},              // Daz
        {"$thighbend", "$shin", "$foot", "$toe"},
        {"#leg", "#knee", "#ankle", "#toe"},   // VRChat
        {"hip#", "knee#", "ankle#", "foot#"},  // Kinect
        {"$hip", "$knee", "$ankle", "$foot"},
        {"#upperleg", "#lowerleg", "#foot", "#toe"},
        {"#upperleg", "#lowerleg", "#foot", "#toes"},  // Unity
        {"#hip", "#knee", "#ankle", "#toe"},
        {"#thigh", "#shin", "#foot", "#toe"}}},
      // Rigify's pelvis is the lowest of its spine, which elsewhere is above the pelvis: there it is already used.
      {{"pelvis"}, {{"pelvis"}, {"hips"}, {"hip"}, {"spine"}, {"root"}}}};
  return table;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Splits "CC_Base_L_Thigh" into cc, base, l and thigh; a prefix with a colon is left out.
std::vector<std::string> words_of_name(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : lower_case(name.substr(name.rfind(':') + 1))) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// Drops the first words with which most names of a rig begin, such as "Character1_", "CC_Base_" and "J_Bip_". A name
// keeps at least its last word.
void drop_common_words(std::vector<std::vector<std::string>>& names) {
  constexpr double most = 0.75;
  for (;;) {
    std::map<std::string, std::size_t> firsts;
    for (const auto& words : names)
      if (words.size() > 1) ++firsts[words.front()];
    const auto common = std::ranges::find_if(firsts, [&](const auto& first) {
      return static_cast<double>(first.second) > most * static_cast<double>(names.size());
    });
    if (common == firsts.end()) return;
    for (auto& words : names)
      if (words.size() > 1 && words.front() == common->first) words.erase(words.begin());
  }
}

// The names of a rig in lower case, without punctuation and common prefixes: "mixamorig:LeftUpLeg", "Bip01 L Thigh",
// "upper_arm.L" and "J_Bip_C_Hips" as leftupleg, lthigh, upperarml and hips.
std::vector<std::string> plain_names(const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> words;
  for (const std::string& name : names) words.push_back(words_of_name(name));
  drop_common_words(words);
  const bool centred = std::ranges::count_if(words, [](const auto& w) {
                         return w.size() > 1 && (w.front() == "l" || w.front() == "r");
                       }) > 0;
  std::vector<std::string> plain;
  for (auto& name : words) {
    if (centred && name.size() > 1 && name.front() == "c") name.erase(name.begin());
    std::string& text = plain.emplace_back();
    for (const std::string& word : name) text += word;
    for (const std::string prefix : {"mixamorig", "bip01", "bip001"})
      if (text.starts_with(prefix)) text.erase(0, prefix.size());
  }
  return plain;
}

std::string of_side(std::string pattern, bool left) {
  const auto replace = [&](char sign, const std::string& by) {
    if (const std::size_t at = pattern.find(sign); at != std::string::npos)
      pattern = pattern.substr(0, at) + by + pattern.substr(at + 1);
  };
  replace('#', left ? "left" : "right");
  replace('$', left ? "l" : "r");
  return pattern;
}

using Found = std::vector<std::pair<std::string, int>>;  // SMPL's name and the file's joint

// The joints found by the row of the table that finds most of a chain; on a tie the earlier row.
Found best(const Chain& chain, const std::map<std::string, int>& names, bool left) {
  Found most;
  for (const std::vector<std::string>& rig : chain.rigs) {
    Found found;
    for (std::size_t k = 0; k < rig.size(); ++k)
      if (const auto entry = names.find(of_side(rig[k], left)); entry != names.end())
        found.emplace_back(of_side(chain.smpl[k], left), entry->second);
    if (found.size() > most.size()) most = found;
  }
  return most;
}

}  // namespace

std::vector<int> matched_joints(const BvhFile& bvh, const std::map<std::string, std::string>& options) {
  const std::vector<std::string> smpl = smpl_joint_names(24);
  std::vector<std::string> theirs;
  std::map<std::string, int> by_plain;
  for (const BvhJoint& joint : bvh.joints) theirs.push_back(joint.name);
  const std::vector<std::string> plain = plain_names(theirs);
  for (std::size_t j = 0; j < theirs.size(); ++j) {
    // MakeHuman inserts a joint `__UpLeg_L` between the hips and UpLeg_L.
    const auto [entry, fresh] = by_plain.emplace(plain[j], static_cast<int>(j));
    if (!fresh && theirs[entry->second].starts_with("_")) entry->second = static_cast<int>(j);
  }
  std::map<std::string, int> found;
  for (const Chain& chain : chains()) {
    Found both = best(chain, by_plain, true);
    for (const auto& one : best(chain, by_plain, false)) both.push_back(one);
    for (const auto& [name, joint] : both) {
      found[name] = joint;
      by_plain.erase(plain[joint]);
    }
  }
  for (const auto& [name, joint] : options) {
    if (std::find(smpl.begin(), smpl.end(), name) == smpl.end())
      throw Error("`" + name + "` is no joint of SMPL", bvh.file, "joints: " + joined(smpl) + suggestion(name, smpl));
    const auto at = std::find(theirs.begin(), theirs.end(), joint);
    if (at == theirs.end())
      throw Error("has no joint `" + joint + "`", bvh.file, "joints: " + joined(theirs) + suggestion(joint, theirs));
    found[name] = static_cast<int>(at - theirs.begin());
  }
  std::vector<int> result;
  for (const std::string& name : smpl) result.push_back(found.contains(name) ? found[name] : -1);
  for (const std::string needed : {"pelvis", "_hip", "_knee", "_ankle", "_shoulder", "_elbow"})
    for (std::size_t j = 0; j < smpl.size(); ++j)
      if (smpl[j].ends_with(needed) && result[j] < 0)
        throw Error("has no joint that is known as " + smpl[j], bvh.file,
                    "say which one it is beside the clip in the scene, joints: {" + smpl[j] + ": NAME}, one of " +
                        joined(theirs));
  return result;
}

}  // namespace selvedge
