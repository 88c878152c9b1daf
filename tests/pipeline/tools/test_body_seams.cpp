#include <catch2/catch.hpp>

#include "pipeline/tools/check.hpp"
#include "pipeline/tools/push_mesh.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/loose_box.hpp"

namespace selvedge::test_body_seams {

TEST_CASE("check, push and untangle close the seams of a body as simulate does") {
  struct Case {
    double gap;  // of the body's lid [m]; its edges are 0.1 long
    bool closed;
  };
  const fake::Folder folder("body_seams");
  // One triangle inside of the body.
  const std::filesystem::path cloth =
      fake::write(folder, "cloth.obj", "v 0.03 0.05 0.03\nv 0.06 0.05 0.03\nv 0.03 0.05 0.06\nf 1 2 3\n");
  for (const Case& one : {Case{0, true}, Case{1e-4, true}, Case{0.01, false}}) {
    INFO(one.gap);
    const std::filesystem::path body = fake::write(folder, "body.obj", fake::loose_box(one.gap));
    CheckRequest checked;
    checked.file = cloth;
    checked.bodies = {body};
    CHECK(check(checked).inside_vertices == (one.closed ? 3 : 0));
    PushRequest push;
    push.file = cloth;
    push.body = body;
    CHECK(push_mesh(push).body_closed == one.closed);
    UntangleRequest untangle;
    untangle.file = cloth;
    untangle.out = folder.path / "out.obj";
    untangle.bodies = {body};
    const UntangleReport report = untangle_mesh(untangle);
    CHECK(report.inside_before == (one.closed ? 3 : 0));
    CHECK(report.warnings.empty() == one.closed);
  }
}

}  // namespace selvedge::test_body_seams
