#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/run/prepare.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/program.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_main {

namespace {

struct Ended {
  int status = -1;
  std::string out, err;
};

Ended selvedge_program(const fake::Folder& folder, const std::string& arguments, const std::string& before = "",
                       const std::string& into = "") {
  const std::filesystem::path out = into.empty() ? folder.path / "stdout" : std::filesystem::path(into),
                              err = folder.path / "stderr";
  const std::string command = before + tested_program() + " " + arguments + " >" + out.string() + " 2>" + err.string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, into.empty() ? fake::whole(out) : "", fake::whole(err)};
}

void write_scene(const fake::Folder& folder) {
  std::ofstream(folder.path / "scene.yaml") << R"(
cloths:
  - name: sheet
    rectangle: {size: [0.2, 0.2], resolution: 6}
    pins: [{group: [top_left, top_right]}]
run: {frames: 3, fps: 30}
)";
}

}  // namespace

TEST_CASE("a scene goes in and an audited trajectory comes out") {
  const fake::Folder folder("main_simulate");
  write_scene(folder);
  const std::string scene = (folder.path / "scene.yaml").string(), out = (folder.path / "out").string();
  const Ended run = selvedge_program(folder, "simulate " + scene + " --json --set run.frames=4 --out " + out);
  INFO(run.err);
  REQUIRE(run.status == 0);
  const auto summary = nlohmann::json::parse(run.out);
  REQUIRE(summary["frames"] == 4);
  REQUIRE(summary["clean"] == true);
  REQUIRE(run.err.find("intersecting pairs") != std::string::npos);
  for (const char* name : {"run.h5", "run.xdmf", "summary.json", "config.yaml", "view.html"})
    REQUIRE(std::filesystem::file_size(folder.path / "out" / name) > 0);

  const Ended check = selvedge_program(folder, "check " + out + "/run.h5 --json");
  REQUIRE(check.status == 0);
  const auto report = nlohmann::json::parse(check.out);
  REQUIRE(report["frames"] == 5);
  REQUIRE(report["intersecting_pairs"] == 0);
  REQUIRE(report["max_stretch"] > 1.0);

  const Ended exported = selvedge_program(folder, "export " + out + " --format pc2 --json --out " + out + "/pc2");
  REQUIRE(exported.status == 0);
  REQUIRE(nlohmann::json::parse(exported.out)["files"].size() == 2);

  // The configuration that a run keeps gives the same run again.
  const Ended again = selvedge_program(folder, "simulate " + out + "/config.yaml --no-view --out " + out + "2");
  INFO(again.err);
  REQUIRE(again.status == 0);
  const TrajectoryReader a(out + "/run.h5"), b(out + "2/run.h5");
  REQUIRE(b.frame_count() == 5);
  REQUIRE(a.frame(4).x == b.frame(4).x);
}

TEST_CASE("plan and info print one JSON object") {
  const fake::Folder folder("main_plan");
  write_scene(folder);
  const Ended plan = selvedge_program(folder, "plan --json " + (folder.path / "scene.yaml").string());
  INFO(plan.err);
  REQUIRE(plan.status == 0);
  const auto lines = nlohmann::json::parse(plan.out)["plan"];
  REQUIRE(lines.size() > 3);
  bool wind_is_out = false;
  for (const auto& line : lines) wind_is_out |= line["feature"] == "wind" && line["in"] == false;
  REQUIRE(wind_is_out);
  const std::string icm = (folder.path / "scene.yaml").string() + " --set run.stepper=icm";
  REQUIRE(selvedge_program(folder, "plan " + icm).out.find("out  continuous detection") != std::string::npos);
  const Ended info = selvedge_program(folder, "info --json");
  REQUIRE(info.status == 0);
  REQUIRE(nlohmann::json::parse(info.out)["threads"] >= 1);
}

TEST_CASE("an empty text on the command line is refused with the option's name") {
  const fake::Folder folder("main_empty");
  struct Case {
    const char *arguments, *where;
  };
  for (const Case& one :
       {Case{"simulate scene.yaml --out ''", "selvedge: --out: "},
        Case{"export run --format ''", "selvedge: --format: "}, Case{"plan scene.yaml --set ''", "selvedge: --set: "},
        Case{"check ''", "selvedge: file: "}, Case{"weights info ''", "selvedge: file: "}}) {
    const Ended ended = selvedge_program(folder, one.arguments);
    INFO(ended.err);
    CHECK(ended.status == 2);
    CHECK(ended.err.find(std::string(one.where) + "is given an empty text") == 0);
  }
}

TEST_CASE("waiting threads spin briefly unless the user says otherwise") {
  const fake::Folder folder("main_threads");
  const Ended info =
      selvedge_program(folder, "info --json", "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=VERBOSE ");
  REQUIRE(info.status == 0);
  if (info.err.find("GOMP_SPINCOUNT") == std::string::npos) {
    WARN("skipped: this OpenMP library does not tell how its threads wait");
    return;
  }
  CHECK(info.err.find("GOMP_SPINCOUNT = '10000'") != std::string::npos);
  CHECK(nlohmann::json::parse(info.out)["waiting"] == "GOMP_SPINCOUNT=10000");
  const Ended passive = selvedge_program(folder, "info --json", "env OMP_WAIT_POLICY=passive ");
  CHECK(nlohmann::json::parse(passive.out)["waiting"] == "OMP_WAIT_POLICY=passive");
}

TEST_CASE("bad input ends with status 2 and says what, where and the cure") {
  const fake::Folder folder("main_bad");
  write_scene(folder);
  const std::string scene = (folder.path / "scene.yaml").string();
  for (const std::string arguments :
       {"simulate absent.yaml", "check absent.obj", "check absent.h5", "export absent.h5", "view absent.h5",
        "ccd absent.csv", "dress absent.obj --out garment.h5", "body absent.npz --out body.h5"}) {
    const Ended outcome = selvedge_program(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    REQUIRE(outcome.status == 2);
    REQUIRE(outcome.out.empty());
    REQUIRE(outcome.err.find("absent") != std::string::npos);
    REQUIRE(outcome.err.find("cure:") != std::string::npos);
  }
  const std::string mesh = fake::write(folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n").string();
  for (const auto& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
           {"fit absent --reach 0", "--reach: is `0`; give a number above 0"},
           {"fit absent --reach nan", "--reach: is `nan`; give a number above 0"},
           {"fit absent --frame -1", "--frame: is `-1`; give a number of at least 0"},
           {"push " + mesh + " " + mesh + " --out b.obj --margin inf", "--margin: is `inf`; give"},
           {"dress " + mesh + " --body absent.h5 --out b.h5", "absent.h5\n  cure: check the path"},
           {"dress " + mesh + " --time 1 --out b.h5", "--time requires --pose"},
           {"weights halve " + mesh + " --out " + mesh, "a.obj: is the file that is read"}}) {
    const Ended outcome = selvedge_program(folder, arguments);
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(words) != std::string::npos);
  }
  const Ended magic = selvedge_program(folder, "simulate " + scene + " --stepper magic");
  REQUIRE(magic.status == 2);
  REQUIRE(magic.err.find("icm") != std::string::npos);
  REQUIRE(selvedge_program(folder, "simulate " + scene + " --set run.framez=3").err.find("frames") !=
          std::string::npos);
  REQUIRE(selvedge_program(folder, "no_such_command").status == 2);
  REQUIRE(selvedge_program(folder, "").status == 2);
  REQUIRE(selvedge_program(folder, "--help").status == 0);
  REQUIRE(selvedge_program(folder, "simulate " + scene + " --resume --out " + (folder.path / "new").string()).status ==
          2);
}

TEST_CASE("a weight file may lie anywhere, and one that nothing runs is named") {
  const fake::Folder folder("main_weights");
  write_scene(folder);
  const std::filesystem::path odd = folder.path / "a #1: [b] 'c'";
  std::filesystem::create_directory(odd);
  std::filesystem::copy_file(source_root() / "configs/weights/hood.h5", odd / "w #2.h5");
  const std::string weights =
      (folder.path / "scene.yaml").string() + " --weights \"" + (odd / "w #2.h5").string() + "\"";
  const Ended learned = selvedge_program(folder, "plan --json --stepper learned " + weights);
  INFO(learned.err);
  REQUIRE(learned.status == 0);
  const auto plan = nlohmann::json::parse(learned.out);
  CHECK(plan["plan"][0]["feature"] == "network");
  REQUIRE(plan["warnings"].size() == 1);  // cotton
  CHECK(plan["warnings"][0].get<std::string>().find("mu is 385") != std::string::npos);
  const Ended conventional = selvedge_program(folder, "plan " + weights);
  CHECK(conventional.status == 0);
  CHECK(conventional.out.find("--weights has no part in the stepper `conventional`") != std::string::npos);
}

TEST_CASE("a denied contact ends with status 1") {
  const fake::Folder folder("main_ccd");
  std::filesystem::create_directories(folder.path / "edge-edge");
  const std::string file = (folder.path / "edge-edge" / "queries.csv").string();
  const auto status = [&](const char* truth) {
    std::ofstream out(file);
    for (const char* node : {"-1,1,1,1,0,1", "1,1,1,1,0,1", "0,1,0,1,-1,1", "0,1,0,1,1,1",  //
                             "-1,1,1,2,0,1", "1,1,1,2,0,1", "0,1,0,1,-1,1", "0,1,0,1,1,1"})
      out << node << "," << truth << "\n";
    out.close();
    const Ended outcome = selvedge_program(folder, "ccd --json " + file);
    INFO(outcome.err);
    REQUIRE(nlohmann::json::parse(outcome.out)["queries"] == 1);
    REQUIRE(nlohmann::json::parse(outcome.out)["false_negatives"] == outcome.status);
    return outcome.status;
  };
  REQUIRE(status("0") == 0);
  REQUIRE(status("1") == 1);
}

TEST_CASE("a dirty mesh ends with status 1") {
  const fake::Folder folder("main_dirty");
  std::ofstream(folder.path / "crossing.obj")
      << "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.2 -1 0.2\nv 0.2 1 0.2\nv 0.2 0 0.9\nf 1 2 3\nf 4 5 6\n";
  const Ended outcome = selvedge_program(folder, "check --json " + (folder.path / "crossing.obj").string());
  REQUIRE(outcome.status == 1);
  REQUIRE(nlohmann::json::parse(outcome.out)["intersecting_pairs"] == 1);
}

// On a busy machine a short run may be over before it is interrupted: then it is tried with a longer one.
TEST_CASE("a run that is interrupted, hung up or killed is resumed to the same bits") {
  const int signal = GENERATE(SIGINT, SIGHUP, SIGKILL);
  const fake::Folder folder("main_interrupt_" + std::to_string(signal));
  write_scene(folder);
  const std::string scene = (folder.path / "scene.yaml").string(), out = (folder.path / "out").string();
  const auto frames_there = [&] {
    return std::filesystem::exists(out + "/run.h5") ? TrajectoryReader(out + "/run.h5").frame_count() : 0;
  };
  int wanted = 400, status = 0;
  for (;; wanted *= 4) {
    std::filesystem::remove_all(out);
    const std::string frames = "run.frames=" + std::to_string(wanted);
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGHUP, SIG_DFL);  // `nohup` may have started the tests
      std::freopen("/dev/null", "w", stdout);
      std::freopen("/dev/null", "w", stderr);
      execl(tested_program(), "selvedge", "simulate", scene.c_str(), "--no-view", "--set", frames.c_str(), "--out",
            out.c_str(), nullptr);
      _exit(127);
    }
    while (frames_there() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(child, signal);
    waitpid(child, &status, 0);
    REQUIRE((WIFEXITED(status) || signal == SIGKILL));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || wanted > 20000) break;
  }
  const std::string arguments =
      "simulate " + scene + " --no-view --set run.frames=" + std::to_string(wanted) + " --out ";
  REQUIRE(frames_there() < wanted + 1);
  if (signal != SIGKILL) {
    REQUIRE(WEXITSTATUS(status) == 1);
    REQUIRE(TrajectoryReader(out + "/run.h5").closed());
    REQUIRE(nlohmann::json::parse(fake::whole(out + "/summary.json"))["end"] == "interrupted");
  }

  REQUIRE(selvedge_program(folder, arguments + out + " --resume").status == 0);
  REQUIRE(selvedge_program(folder, arguments + out + "2").status == 0);
  const TrajectoryReader resumed(out + "/run.h5"), whole(out + "2/run.h5");
  REQUIRE(resumed.frame_count() == wanted + 1);
  for (const int i : {10, wanted / 2, wanted}) REQUIRE(resumed.frame(i).x == whole.frame(i).x);
}

TEST_CASE("an outcome that did not come true is in the object, which is not clean") {
  const fake::Folder folder("main_outcome");
  write_scene(folder);
  std::ofstream(folder.path / "scene.yaml", std::ios::app)
      << "outcome: [{name: flies, outside: {min: [-1, -1, -1], max: [1, 1, 1]}, least: 5}]\n";
  const std::string arguments =
      "simulate " + (folder.path / "scene.yaml").string() + " --no-view --json --out " + (folder.path / "out").string();
  const Ended run = selvedge_program(folder, arguments);
  CHECK(run.status == 1);
  CHECK(run.err.find("flies: no") != std::string::npos);
  const auto summary = nlohmann::json::parse(run.out);
  CHECK(summary["end"] == "finished");
  CHECK(summary["clean"] == false);
  CHECK(summary["outcomes"][0]["came_true"] == false);
  const Ended again = selvedge_program(folder, arguments + " --resume=auto");
  CHECK(again.status == 1);
  CHECK(again.out == run.out);
}

TEST_CASE("--resume=auto starts, goes on, or reports the run that has ended") {
  const fake::Folder folder("main_auto");
  write_scene(folder);
  const std::filesystem::path out = folder.path / "out";
  const std::string arguments = "simulate " + (folder.path / "scene.yaml").string() + " --no-view --json --out " +
                                out.string() + " --resume=auto";
  const Ended started = selvedge_program(folder, arguments);
  INFO(started.err);
  REQUIRE(started.status == 0);
  const auto written = std::filesystem::last_write_time(out / "run.h5");
  const Ended reported = selvedge_program(folder, arguments);
  CHECK(reported.status == 0);
  CHECK(reported.out == started.out);
  CHECK(reported.err.find("finished, 3 of 3 frames, clean") != std::string::npos);
  CHECK(std::filesystem::last_write_time(out / "run.h5") == written);
  const Ended other = selvedge_program(folder, arguments + " --set run.frames=4");
  CHECK(other.status == 2);
  CHECK(other.err.find("another configuration") != std::string::npos);
  CHECK(selvedge_program(folder, arguments + "s").status == 2);
}

TEST_CASE("--resume=auto goes on with a draped start that was stopped, and says so") {
  const fake::Folder folder("main_draping");
  fake::write_skirt(folder);
  const std::filesystem::path out = folder.path / "out", file = folder.path / "scene.yaml";
  std::ofstream(file) << "cloths: [{garment: skirt.h5, start: {from: draped, seconds: 0.2, hold: 0.1}}]\n"
                         "obstacles: [{name: person, body: {clip: walk, room: 0}}]\nrun: {frames: 2, fps: 20}\n";
  const Setup setup = read_setup(file);
  std::filesystem::create_directories(out);
  int asked = 0;
  REQUIRE_FALSE(prepare(
      setup, [&] { return ++asked == 3; }, nullptr, {}, KeptDraping{out}));
  const std::string arguments = "simulate " + file.string() + " --no-view --out ";
  const Ended resumed = selvedge_program(folder, arguments + out.string() + " --resume=auto");
  INFO(resumed.out << resumed.err);
  CHECK(resumed.out.find("goes on with the draped start") != std::string::npos);
  CHECK(resumed.out.find("(3 of them before it was stopped)") != std::string::npos);
  const Ended whole = selvedge_program(folder, arguments + out.string() + "2 --resume=auto");
  CHECK(whole.out.find("starts: nothing to go on from") != std::string::npos);
  CHECK(TrajectoryReader(out / "run.h5").frame(2).x == TrajectoryReader(out.string() + "2/run.h5").frame(2).x);
}

TEST_CASE("a limit on the size of files ends a run with a sentence and status 2, as a full disk does") {
  const fake::Folder folder("main_file_limit");
  write_scene(folder);
  const std::string scene = (folder.path / "scene.yaml").string();
  int failed = 0;
  for (const int blocks : {8, 64, 128, 192}) {
    const Ended run =
        selvedge_program(folder,
                         "simulate " + scene + " --no-view --set cloths.sheet.rectangle.resolution=30 --out " +
                             (folder.path / "out").string(),
                         "ulimit -f " + std::to_string(blocks) + "; ");
    INFO(blocks << ": " << run.status << "\n" << run.err);
    CHECK((run.status == 0 || run.status == 2));
    if (run.status == 0) continue;
    ++failed;
    CHECK(run.err.find("cannot ") != std::string::npos);
    CHECK(run.err.find("File too large") != std::string::npos);
    CHECK(run.err.find("cure: ") != std::string::npos);
  }
  CHECK(failed > 1);
}

TEST_CASE("a number and its noun agree in what commands print") {
  const fake::Folder folder("main_plurals");
  write_scene(folder);
  const std::string out = (folder.path / "out").string();
  std::ofstream(folder.path / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
  std::ofstream(folder.path / "pin.yaml")
      << "cloths: [{name: sheet, rectangle: {size: [0.2, 0.2], resolution: 5}, pins: [{vertices: [12]}]}]\n"
         "obstacles: [{name: ball, sphere: {radius: 0.05}}]\nrun: {frames: 1}\n";
  for (const std::string& arguments :
       {"check " + (folder.path / "one.obj").string(),
        "simulate " + (folder.path / "pin.yaml").string() + " --no-view --out " + out,
        "plan " + (folder.path / "pin.yaml").string(), "export " + out + " --format obj --out " + out}) {
    const Ended run = selvedge_program(folder, arguments);
    INFO(run.out << run.err);
    CHECK(run.status < 2);
    const std::string all = run.out + run.err;
    for (const char* word : {"frames", "pins", "pairs", "vertices", "triangles", "obstacles", "files", "bodies"})
      for (std::size_t at = all.find(word); at != std::string::npos; at = all.find(word, at + 1))
        CHECK_FALSE((at > 2 && all.substr(at - 2, 2) == "1 " && std::isdigit(all[at - 3]) == 0 && all[at - 3] != '.'));
  }
}

TEST_CASE("what cannot be printed ends with status 2") {
  if (!std::filesystem::exists("/dev/full")) return;
  const fake::Folder folder("main_full");
  write_scene(folder);
  const std::string scene = (folder.path / "scene.yaml").string();
  for (const std::string& arguments : {std::string("--help"), std::string("--version"), std::string("info"),
                                       std::string("info --json"), "plan " + scene, "plan --json " + scene,
                                       "simulate " + scene + " --no-view --out " + (folder.path / "out").string()}) {
    const Ended full = selvedge_program(folder, arguments, "", "/dev/full");
    INFO(arguments << "\n" << full.err);
    CHECK(full.status == 2);
    CHECK(full.err.find("standard output: cannot be written") != std::string::npos);
  }
}

TEST_CASE("a request for 100,000 threads is not taken seriously") {
  const fake::Folder folder("main_many_threads");
  write_scene(folder);
  const std::string out = (folder.path / "out").string();
  for (const char* many : {"100000", "2,100000", "99999999999999999999"}) {
    const std::string before = std::string("env OMP_NUM_THREADS=") + many + " ";
    const Ended info = selvedge_program(folder, "info --json", before);
    INFO(info.err);
    CHECK(info.err.find("warning: OMP_NUM_THREADS=") != std::string::npos);
    CHECK(nlohmann::json::parse(info.out)["threads"] <= std::max(1u, std::thread::hardware_concurrency()));
    CHECK(selvedge_program(folder, "simulate " + (folder.path / "scene.yaml").string() + " --no-view --out " + out,
                           before)
              .status == 0);
  }
}

TEST_CASE("no message of a library stands alone, and none ends early") {
  const fake::Folder folder("main_messages");
  std::ofstream(folder.path / "a.gltf") << "{\"asset\n";
  const std::string body = " --out " + (folder.path / "b.h5").string();
  const Ended gltf = selvedge_program(folder, "body " + (folder.path / "a.gltf").string() + body);
  CHECK(gltf.status == 2);
  CHECK(gltf.err.find("a.gltf: is no glTF 2.0") != std::string::npos);
  CHECK(gltf.err.find("json.exception") == std::string::npos);
  std::ofstream(folder.path / "nul.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3" << '\0' << "\n";
  const Ended nul = selvedge_program(folder, "check " + (folder.path / "nul.obj").string());
  INFO(nul.err);
  CHECK(nul.status == 2);
  CHECK(nul.err.find("nul.obj:4: `3\\0") != std::string::npos);
  CHECK(nul.err.find("cure: ") != std::string::npos);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  std::ofstream(folder.path / "large.obj") << "v 0 0 0\n";
  std::filesystem::resize_file(folder.path / "large.obj", 1 << 30);
  const Ended large =
      selvedge_program(folder, "check " + (folder.path / "large.obj").string(), "ulimit -v 900000; OMP_NUM_THREADS=1 ");
  INFO(large.err);
  CHECK(large.status == 2);
  CHECK(large.err.find("check: needs more memory than there is\n  cure: ") != std::string::npos);
#endif
}

TEST_CASE("help stands in four groups, and a mistyped command names its neighbour") {
  const fake::Folder folder("main_help");
  const Ended help = selvedge_program(folder, "--help");
  REQUIRE(help.status == 0);
  const std::size_t use = help.out.find("\nUse"), prepare = help.out.find("\nPrepare"),
                    measure = help.out.find("\nMeasure"), works = help.out.find("\nLong works");
  REQUIRE((use != std::string::npos && prepare != std::string::npos && measure != std::string::npos));
  REQUIRE(help.out.find("  simulate") > use);
  REQUIRE(help.out.find("  dress") > prepare);
  REQUIRE(help.out.find("  validate") > measure);
  REQUIRE(works > help.out.find("  validate"));
  REQUIRE((works < help.out.find("  cells") && help.out.find("  gather") != std::string::npos));
  const Ended mistyped = selvedge_program(folder, "simulat scene.yaml");
  REQUIRE(mistyped.status == 2);
  REQUIRE(mistyped.err.find("there is no command `simulat`; did you mean `simulate`?") != std::string::npos);
  for (const std::string arguments : {"simulate", "info --jsn", "untangle a.obj --out b.obj --layers 1,b"}) {
    const Ended refused = selvedge_program(folder, arguments);
    const std::string command = arguments.substr(0, arguments.find(' '));
    INFO(refused.err);
    CHECK(refused.status == 2);
    CHECK(refused.err.starts_with("selvedge: " + command + ": "));
    CHECK(refused.err.find("cure: `selvedge " + command + " --help`") != std::string::npos);
  }
  CHECK(selvedge_program(folder, "simulate --help").out.find("--resume") != std::string::npos);
}

}  // namespace selvedge::test_main
