// SPDX-License-Identifier: BSD-3-Clause
// report.html for bodies that are too large for a view, and for fields of the wrong length.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "program/report_page.hpp"

using namespace kacanov;

namespace {

struct SmallPage {
  Mesh mesh = make_box({{2, 1, 1}, {4, 2, 2}, ElementType::tet4});  // 80 triangles
  Case input;
  nlohmann::ordered_json result{{"status", "converged"}};
  std::vector<double> displacement = std::vector<double>(mesh.coordinates.size(), 0.0);
  ShownRun shown;

  SmallPage() {
    shown.fields = {{"von Mises stress", std::vector<double>(mesh.node_count(), 1.0)}};
    shown.not_shown = {"There is no wind."};
  }
  ReportPage page() const { return {&input, &result, "step\n", &mesh, displacement, &shown}; }
};

nlohmann::json scene_of(const std::string& html) {
  const std::string mark = "id=\"scene\">";
  const std::size_t from = html.find(mark) + mark.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

}  // namespace

TEST_CASE("a body with more triangles than a page can hold has none of them there, and their number") {
  const SmallPage small;
  ReportPage page = small.page();
  page.most_triangles = 80;
  nlohmann::json scene = scene_of(report_html(page));
  CHECK(scene["triangles"] == 80);
  CHECK(scene.contains("points"));
  const std::size_t whole = report_html(page).size();
  page.most_triangles = 79;
  scene = scene_of(report_html(page));
  CHECK(scene["triangles"] == 80);
  CHECK(scene["most"] == 79);
  CHECK(scene["not_shown"] == nlohmann::json{"There is no wind."});
  CHECK_FALSE(scene.contains("points"));
  CHECK_FALSE(scene.contains("fields"));
  CHECK(report_html(page).size() + 1000 < whole);
}

TEST_CASE("a body of revolution shows its axis, about the middle of the body, where it is near") {
  SmallPage small;
  CHECK_FALSE(scene_of(report_html(small.page())).contains("axis"));
  small.mesh = make_box({{2, 1, 0}, {4, 2, 0}, ElementType::quad4});
  small.displacement.assign(small.mesh.coordinates.size(), 0.0);
  small.shown.fields[0].values.assign(small.mesh.node_count(), 1.0);
  CHECK_FALSE(scene_of(report_html(small.page())).contains("axis"));
  small.mesh.plane = PlaneState::axisymmetric;
  const nlohmann::json axis = scene_of(report_html(small.page())).at("axis");
  CHECK(axis["x"] == -1.0);
  CHECK(axis["reach"].get<double>() == doctest::Approx(0.6));
  for (std::size_t i = 0; i < small.mesh.coordinates.size(); i += 2) small.mesh.coordinates[i] += 3.0;
  CHECK_FALSE(scene_of(report_html(small.page())).contains("axis"));
}

TEST_CASE("a field that does not fit the mesh is refused") {
  SmallPage small;
  small.shown.fields[0].values.pop_back();
  CHECK_THROWS_AS(report_html(small.page()), InternalError);
  small.shown.fields.clear();
  CHECK(scene_of(report_html(small.page()))["fields"].empty());
}
