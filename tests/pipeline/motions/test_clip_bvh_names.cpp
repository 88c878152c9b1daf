#include <catch2/catch.hpp>

#include <functional>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_clip_bvh_names {
using Catch::Matchers::Contains;

namespace {

// How rigs call pelvis, two joints of the spine, neck and head, then collar, shoulder, elbow and wrist of the left and
// of the right arm, then hip, knee, ankle and foot of both legs.
const std::vector<std::pair<std::string, std::string>> rigs = {
    {"bandai_style",
     "Hips,Spine,Chest,Neck,Head,Shoulder_L,UpperArm_L,LowerArm_L,Hand_L,Shoulder_R,UpperArm_R,LowerArm_R,Hand_R,"
     "UpperLeg_L,LowerLeg_L,Foot_L,Toes_L,UpperLeg_R,LowerLeg_R,Foot_R,Toes_R"},
    {"bvhacker",
     "hip,abdomen,chest,neck,head,lCollar,lShldr,lForeArm,lHand,rCollar,rShldr,rForeArm,rHand,lThigh,lShin,lFoot,lToe,"
     "rThigh,rShin,rFoot,rToe"},
    {"maya_blender_mix",
     "Hips,Spine,Chest,Neck,Head,Shoulder_L,Upper_Arm_L,Forearm_L,Hand_L,Shoulder_R,Upper_Arm_R,Forearm_R,Hand_R,Thigh_"
     "L,Shin_L,Foot_L,Toe_L,Thigh_R,Shin_R,Foot_R,Toe_R"},
    {"mixamo",
     "mixamorig:Hips,mixamorig:Spine,mixamorig:Spine1,mixamorig:Neck,mixamorig:Head,mixamorig:LeftShoulder,mixamorig:"
     "LeftArm,mixamorig:LeftForeArm,mixamorig:LeftHand,mixamorig:RightShoulder,mixamorig:RightArm,mixamorig:"
     "RightForeArm,mixamorig:RightHand,mixamorig:LeftUpLeg,mixamorig:LeftLeg,mixamorig:LeftFoot,mixamorig:LeftToeBase,"
     "mixamorig:RightUpLeg,mixamorig:RightLeg,mixamorig:RightFoot,mixamorig:RightToeBase"},
    {"motionbuilder_ref",
     "Character1_Hips,Character1_Spine,Character1_Spine1,Character1_Neck,Character1_Head,Character1_LeftShoulder,"
     "Character1_LeftArm,Character1_LeftForeArm,Character1_LeftHand,Character1_RightShoulder,Character1_RightArm,"
     "Character1_RightForeArm,Character1_RightHand,Character1_LeftUpLeg,Character1_LeftLeg,Character1_LeftFoot,"
     "Character1_LeftToeBase,Character1_RightUpLeg,Character1_RightLeg,Character1_RightFoot,Character1_RightToeBase"},
    {"perception_neuron",
     "Hips,Spine,Spine1,Neck,Head,LeftShoulder,LeftArm,LeftForeArm,LeftHand,RightShoulder,RightArm,RightForeArm,"
     "RightHand,LeftUpLeg,LeftLeg,LeftFoot,LeftFoot_End,RightUpLeg,RightLeg,RightFoot,RightFoot_End"},
    {"reallusion",
     "CC_Base_Hip,CC_Base_Waist,CC_Base_Spine01,CC_Base_NeckTwist01,CC_Base_Head,CC_Base_L_Clavicle,CC_Base_L_Upperarm,"
     "CC_Base_L_Forearm,CC_Base_L_Hand,CC_Base_R_Clavicle,CC_Base_R_Upperarm,CC_Base_R_Forearm,CC_Base_R_Hand,CC_Base_"
     "L_Thigh,CC_Base_L_Calf,CC_Base_L_Foot,CC_Base_L_ToeBase,CC_Base_R_Thigh,CC_Base_R_Calf,CC_Base_R_Foot,CC_Base_R_"
     "ToeBase"},
    {"rigify",
     "DEF-spine,DEF-spine.001,DEF-spine.002,DEF-spine.005,DEF-spine.006,DEF-shoulder.L,DEF-upper_arm.L,DEF-forearm.L,"
     "DEF-hand.L,DEF-shoulder.R,DEF-upper_arm.R,DEF-forearm.R,DEF-hand.R,DEF-thigh.L,DEF-shin.L,DEF-foot.L,DEF-toe.L,"
     "DEF-thigh.R,DEF-shin.R,DEF-foot.R,DEF-toe.R"},
    {"rokoko",
     "Hips,Spine1,Spine2,Neck,Head,LeftShoulder,LeftArm,LeftForeArm,LeftHand,RightShoulder,RightArm,RightForeArm,"
     "RightHand,LeftThigh,LeftShin,LeftFoot,LeftToe,RightThigh,RightShin,RightFoot,RightToe"},
    {"unity",
     "Hips,Spine,Chest,Neck,Head,LeftShoulder,LeftUpperArm,LeftLowerArm,LeftHand,RightShoulder,RightUpperArm,"
     "RightLowerArm,RightHand,LeftUpperLeg,LeftLowerLeg,LeftFoot,LeftToes,RightUpperLeg,RightLowerLeg,RightFoot,"
     "RightToes"},
    {"vrm",
     "J_Bip_C_Hips,J_Bip_C_Spine,J_Bip_C_Chest,J_Bip_C_Neck,J_Bip_C_Head,J_Bip_L_Shoulder,J_Bip_L_UpperArm,J_Bip_L_"
     "LowerArm,J_Bip_L_Hand,J_Bip_R_Shoulder,J_Bip_R_UpperArm,J_Bip_R_LowerArm,J_Bip_R_Hand,J_Bip_L_UpperLeg,J_Bip_L_"
     "LowerLeg,J_Bip_L_Foot,J_Bip_L_ToeBase,J_Bip_R_UpperLeg,J_Bip_R_LowerLeg,J_Bip_R_Foot,J_Bip_R_ToeBase"},
    {"xsens",
     "Pelvis,L5,T8,Neck,Head,LeftShoulder,LeftUpperArm,LeftForeArm,LeftHand,RightShoulder,RightUpperArm,RightForeArm,"
     "RightHand,LeftUpperLeg,LeftLowerLeg,LeftFoot,LeftToe,RightUpperLeg,RightLowerLeg,RightFoot,RightToe"},
    {"biped",
     "Bip01 Pelvis,Bip01 Spine,Bip01 Spine1,Bip01 Neck,Bip01 Head,Bip01 L Clavicle,Bip01 L UpperArm,Bip01 L "
     "Forearm,Bip01 L Hand,Bip01 R Clavicle,Bip01 R UpperArm,Bip01 R Forearm,Bip01 R Hand,Bip01 L Thigh,Bip01 L "
     "Calf,Bip01 L Foot,Bip01 L Toe0,Bip01 R Thigh,Bip01 R Calf,Bip01 R Foot,Bip01 R Toe0"},
    {"daz",
     "hip,abdomenLower,abdomenUpper,neckLower,head,lCollar,lShldrBend,lForearmBend,lHand,rCollar,rShldrBend,"
     "rForearmBend,rHand,lThighBend,lShin,lFoot,lToe,rThighBend,rShin,rFoot,rToe"},
    {"vrchat",
     "Hips,Spine,Chest,Neck,Head,Left shoulder,Left arm,Left elbow,Left wrist,Right shoulder,Right arm,Right "
     "elbow,Right wrist,Left leg,Left knee,Left ankle,Left toe,Right leg,Right knee,Right ankle,Right toe"},
    {"motive",
     "Hip,Ab,Chest,Neck,Head,LShoulder,LUArm,LFArm,LHand,RShoulder,RUArm,RFArm,RHand,LThigh,LShin,LFoot,LToe,RThigh,"
     "RShin,RFoot,RToe"},
    {"rig of a studio",
     "Hero_Hips,Hero_Spine,Hero_Spine1,Hero_Neck,Hero_Head,Hero_LeftShoulder,Hero_LeftArm,Hero_LeftForeArm,Hero_"
     "LeftHand,Hero_RightShoulder,Hero_RightArm,Hero_RightForeArm,Hero_RightHand,Hero_LeftUpLeg,Hero_LeftLeg,Hero_"
     "LeftFoot,Hero_LeftToeBase,Hero_RightUpLeg,Hero_RightLeg,Hero_RightFoot,Hero_RightToeBase"},
};

const std::vector<std::string> smpl_of = {
    "pelvis",     "spine",      "spine",        "neck",           "head",        "left_collar", "left_shoulder",
    "left_elbow", "left_wrist", "right_collar", "right_shoulder", "right_elbow", "right_wrist", "left_hip",
    "left_knee",  "left_ankle", "left_foot",    "right_hip",      "right_knee",  "right_ankle", "right_foot"};

std::vector<std::string> split_names(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');) names.push_back(name);
  return names;
}

// A figure that stands, arms out, facing z, in centimetres, in a frame whose joints turn by `degrees` about z. `flat`:
// its zero pose has all bones along x, and the frame turns the limbs to where they should be.
std::string figure(const std::vector<std::string>& names, bool flat) {
  const std::vector<int> parent = {-1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 15, 0, 17, 18, 19};
  const std::vector<Vec3> offset = {{0, 90, 0},  {0, 10, 0},  {0, 15, 0},  {0, 20, 0},  {0, 8, 0},   {5, 15, 0},
                                    {12, 0, 0},  {26, 0, 0},  {24, 0, 0},  {-5, 15, 0}, {-12, 0, 0}, {-26, 0, 0},
                                    {-24, 0, 0}, {9, -4, 0},  {0, -40, 0}, {0, -40, 0}, {0, -5, 12}, {-9, -4, 0},
                                    {0, -40, 0}, {0, -40, 0}, {0, -5, 12}};
  std::string text = "HIERARCHY\n", motion = "MOTION\nFrames: 2\nFrame Time: 0.0333333\n";
  std::string first = "0 90 0", second = "0 90 5";
  const std::function<void(std::size_t)> add = [&](std::size_t j) {
    const Vec3& way = offset[j];
    // Legs that hang down in the frame stick out to the side in the flat zero pose.
    const bool thigh = j == 13 || j == 17, leg = j > 13 && j != 17;
    const Vec3 at = flat && leg ? Vec3(way.norm(), 0, 0) : way;
    const std::string turn = flat && thigh ? " 0 0 -90" : " 0 0 0";
    first += turn;
    second += turn;
    text += (j == 0 ? "ROOT " : "JOINT ") + names[j] + "\n{\nOFFSET " + std::to_string(at.x()) + " " +
            std::to_string(at.y()) + " " + std::to_string(at.z()) + "\nCHANNELS " +
            (j == 0 ? "6 Xposition Yposition Zposition " : "3 ") + "Xrotation Yrotation Zrotation\n";
    bool leaf = true;
    for (std::size_t child = 0; child < parent.size(); ++child)
      if (parent[child] == static_cast<int>(j)) {
        add(child);
        leaf = false;
      }
    text += leaf ? "End Site\n{\nOFFSET 0 5 0\n}\n}\n" : "}\n";
  };
  add(0);
  return text + motion + first + "\n" + second + "\n";
}

Setup with_clip(const fake::Folder& folder, const std::string& body) {
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths: [{disc: {radius: 0.1, resolution: 2}, translate: [0, 3, 0]}]\n"
                                "obstacles: [{name: p, body: {model: mannequin, room: 0, " +
                                    body + "}}]\n"));
}

}  // namespace

TEST_CASE("clip_bvh_names: the rigs of other programs are known by their names", "[clip]") {
  for (const auto& [rig, list] : rigs) {
    INFO(rig);
    const std::vector<std::string> names = split_names(list), smpl = smpl_joint_names(24);
    BvhFile bvh;
    for (const std::string& name : names) bvh.joints.push_back({name, -1, {}, {}, 0});
    const std::vector<int> found = matched_joints(bvh, {});
    int known = 0;
    for (std::size_t j = 0; j < found.size(); ++j) {
      if (found[j] < 0) continue;
      ++known;
      INFO(smpl[j] << " is " << names[static_cast<std::size_t>(found[j])]);
      CHECK(smpl[j].starts_with(smpl_of[static_cast<std::size_t>(found[j])]));
    }
    CHECK(known == 21);
  }
}

TEST_CASE("clip_bvh_names: a scene says what a rig calls its joints, and in which frame it stands", "[clip]") {
  const fake::Folder folder("bvh_names");
  std::vector<std::string> names = split_names(rigs.front().second);
  fake::write(folder, "known.bvh", figure(names, false));
  const Points known = with_clip(folder, "clip: known.bvh").drive_at(0).obstacles.at(0);
  CHECK(known.col(1).minCoeff() == Approx(0).margin(0.03));

  names[14] = "Knie links";
  fake::write(folder, "odd.bvh", figure(names, false));
  CHECK_THROWS_WITH(with_clip(folder, "clip: odd.bvh"), Contains("left_knee") && Contains("joints: {left_knee: NAME}"));
  CHECK(with_clip(folder, "clip: odd.bvh, joints: {left_knee: Knie links}").drive_at(0).obstacles.at(0) == known);
  CHECK_THROWS_WITH(with_clip(folder, "clip: walk, joints: {left_knee: Knie}"), Contains("no .bvh"));

  // A zero pose in which nobody stands: the first frame serves, as if the scene had named it.
  names = split_names(rigs.front().second);
  fake::write(folder, "flat.bvh", figure(names, true));
  const Points flat = with_clip(folder, "clip: flat.bvh").drive_at(0).obstacles.at(0);
  CHECK(flat.col(1).minCoeff() == Approx(0).margin(0.03));
  CHECK(flat.col(1).maxCoeff() == Approx(known.col(1).maxCoeff()).margin(0.05));
  CHECK(with_clip(folder, "clip: flat.bvh, rest_frame: 0").drive_at(0).obstacles.at(0) == flat);
  CHECK_THROWS_WITH(with_clip(folder, "clip: flat.bvh, rest_frame: 2"), Contains("has no frame 2"));
}

}  // namespace selvedge::test_clip_bvh_names
