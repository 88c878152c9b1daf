#include <algorithm>
#include <cctype>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/motions/clip_bvh.hpp"

namespace selvedge {
namespace {

// What rigs call the joints of a limb or of the trunk, in the order of SMPL's names; empty: has none. In lower case
// without signs; # stands for left or right, $ for l or r.
struct Chain {
  std::vector<std::string> smpl;
  std::vector<std::vector<std::string>> rigs;
};

const std::vector<Chain>& chains() {
  static const std::vector<Chain> table = {
      {{"spine1", "spine2", "spine3"},
       {{"spine1", "spine2", "spine3"},     // SMPL, MakeHuman's BVH
        {"spine05", "spine03", "spine01"},  // MakeHuman
        {"lowerback", "spine", "spine1"},   // CMU
        {"spine", "spine1", "spine2"},      // Mixamo, LAFAN, Biped
        {"spine01", "spine02", "spine03"},  // Unreal
        {"spine", "chest", "upperchest"},   // Blender, Unity
        {"abdomenlower", "abdomenupper", "chestlower"},
        {"abdomen", "chest", ""},  // Poser
        {"spine", "", "spine1"},
        {"chest", "chest2", "chest3"}}},
      {{"neck", "head"},
       {{"neck", "head"}, {"neck1", "head"}, {"neck01", "head"}, {"neck02", "head"}, {"necklower", "head"}}},
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
        {"#collar", "#uparm", "#lowarm", "#hand", ""},
        {"#shoulder", "#upperarm", "#lowerarm", "#hand", ""}}},
      {{"#_hip", "#_knee", "#_ankle", "#_foot"},
       {{"#hip", "#knee", "#ankle", "#foot"},               // SMPL
        {"#upleg", "#leg", "#foot", "#toebase"},            // CMU, Mixamo
        {"#upleg", "#leg", "#foot", "#toe"},                // LAFAN
        {"upleg$", "loleg$", "foot$", "toe$"},              // MakeHuman's BVH
        {"upperleg01$", "lowerleg01$", "foot$", "toe11$"},  // MakeHuman
        {"thigh$", "calf$", "foot$", "ball$"},              // Unreal
        {"thigh$", "shin$", "foot$", "toe$"},               // Blender
        {"$thigh", "$calf", "$foot", "$toe0"},              // Biped
        {"$femur", "$tibia", "$foot", "$toes"},             // Acclaim
        {"$thigh", "$shin", "$foot", "$toe"},               // Poser
        {"$hip", "$knee", "$ankle", "$foot"},
        {"#upperleg", "#lowerleg", "#foot", "#toe"},
        {"#hip", "#knee", "#ankle", "#toe"},
        {"#thigh", "#shin", "#foot", "#toe"}}},
      {{"pelvis"}, {{"pelvis"}, {"hips"}, {"hip"}, {"root"}}}};
  return table;
}

// "mixamorig:LeftUpLeg", "Bip01 L Thigh" and "upper_arm.L" as leftupleg, lthigh and upperarml.
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name.substr(name.rfind(':') + 1))
    if (std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string prefix : {"mixamorig", "bip01", "bip001"})
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
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

// The naming of the table that finds most of a chain, the earlier one where two find as much.
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
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    theirs.push_back(bvh.joints[j].name);
    // MakeHuman puts a joint `__UpLeg_L` where UpLeg_L hangs on the hips.
    const auto [entry, fresh] = by_plain.emplace(plain(theirs[j]), static_cast<int>(j));
    if (!fresh && theirs[static_cast<std::size_t>(entry->second)].starts_with("_")) entry->second = static_cast<int>(j);
  }
  std::map<std::string, int> found;
  for (const Chain& chain : chains())
    for (const bool left : {true, false})
      for (const auto& [name, joint] : best(chain, by_plain, left)) found[name] = joint;
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
                    "say which one it is: " + smpl[j] + ": one of " + joined(theirs));
  return result;
}

}  // namespace selvedge
