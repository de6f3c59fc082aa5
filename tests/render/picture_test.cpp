#include <limits>

#include "render/scenes.h"

namespace aircut::render {
namespace {

constexpr int side = 400;

TEST(Picture, ShowsABoxOnAsManyPixelsAsItsAreaInAParallelView) {
  Renderer r = renderer(side, side);
  // 100 x 50 mm at 2 pixels a mm.
  const Scene scene = bare_scene({body("box", block(100, 30, 50))});
  const auto counts = r.visible_pixels(scene, front_camera(200));
  EXPECT_NEAR(counts.at(0), 200 * 100, 300);  // half a pixel around
}

TEST(Picture, ShowsABoxOnAsManyPixelsAsItsFrontInPerspective) {
  Renderer r = renderer(side, side);
  Camera camera = front_camera(0);
  camera.field_of_view = 0.5;
  const Scene scene = bare_scene({body("box", block(100, 30, 50))});
  // The front stands 1000 - 15 mm before the eye and hides the rest.
  const double scale = side / (2 * std::tan(0.25) * 985);
  EXPECT_NEAR(r.visible_pixels(scene, camera).at(0), 100 * 50 * scale * scale, 150);
}

TEST(Picture, LetsTheNearBodyHideTheFarOne) {
  Renderer r = renderer(side, side);
  const Scene scene = bare_scene({body("far", block(100, 10, 100), Vec3(0, 50, 0)),
                                  body("near", block(50, 10, 100), Vec3(25, -50, 0)),
                                  body("behind", block(20, 5, 20), Vec3(25, 30, 0))});
  const auto counts = r.visible_pixels(scene, front_camera(200));
  EXPECT_NEAR(counts.at(0), 100 * 200, 220);
  EXPECT_NEAR(counts.at(1), 100 * 200, 220);
  EXPECT_EQ(counts.at(2), 0);
}

TEST(Picture, LetsATranslucentBodyHideNothing) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene(
      {body("far", block(40, 10, 40)), body("cover", block(100, 10, 100), Vec3(0, -50, 0))});
  scene.bodies[1].translucent = true;
  const auto counts = r.visible_pixels(scene, front_camera(200));
  EXPECT_NEAR(counts.at(0), 80 * 80, 100);
  EXPECT_NEAR(counts.at(1), 200 * 200, 300);
  // It shimmers through in the picture, too: the middle is darker than the cover beside it.
  scene.bodies[0].color = {20, 20, 20};
  const Image image = r.draw(scene, front_camera(200));
  EXPECT_LT(pixel(image, 200, 200)[1] + 30, pixel(image, 130, 200)[1]);
}

TEST(Picture, DrawsLitBodiesOnALightGround) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("box", block(100, 30, 50))});
  scene.bodies[0].color = {30, 80, 170};
  const Image image = r.draw(scene, front_camera(200));
  ASSERT_EQ(image.rgba.size(), static_cast<std::size_t>(side) * side * 4);
  const auto ground = pixel(image, 10, 200), blue = pixel(image, 200, 200);
  EXPECT_GT(ground[0], 180);
  EXPECT_GT(blue[2], blue[0] + 40);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) ASSERT_EQ(image.rgba[i], 255);
}

TEST(Picture, MakesTheTopOfABoxBrighterThanItsShadedSide) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("box", block(80, 80, 80))});
  const Image image = r.draw(scene, *camera_by_name("200,-200,200,0,0,0", Box3(), 1));
  // From the front right and above: the top is up in the picture, the right side right below.
  EXPECT_GT(pixel(image, 200, 160)[1], pixel(image, 230, 230)[1] + 15);
}

TEST(Picture, DarkensTheFloorUnderABody) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("roof", block(100, 100, 10), Vec3(0, 0, 60)),
                            body("foot", block(10, 10, 60), Vec3(0, 0, 30))});
  scene.floor = true;
  const Camera camera = *camera_by_name("0,-400,120,0,0,30", Box3(), 1);
  const Image with = r.draw(scene, camera);
  scene.bodies.erase(scene.bodies.begin());
  scene.bodies.push_back(body("far", block(1, 1, 10), Vec3(49, 49, 60)));
  const Image without = r.draw(scene, camera);
  double darker = 0;
  for (int x = 120; x < 280; ++x) darker += pixel(without, x, 250)[1] - pixel(with, x, 250)[1];
  EXPECT_GT(darker / 160, 8);
}

TEST(Picture, ShowsABodyInAlarmThroughItsCover) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene(
      {body("cover", block(100, 10, 100), Vec3(0, -50, 0)), body("hit", block(40, 10, 40))});
  scene.bodies[1].highlight = true;
  EXPECT_EQ(r.visible_pixels(scene, front_camera(200)).at(1), 0);
  const auto reddish = [](const Image& image) {
    int count = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto c = pixel(image, x, y);
        count += c[0] > c[1] + 25 ? 1 : 0;
      }
    return count;
  };
  const int covered = reddish(r.draw(scene, front_camera(200)));
  EXPECT_NEAR(covered, 80 * 80, 500);
  scene.bodies.erase(scene.bodies.begin());
  const Image open = r.draw(scene, front_camera(200));
  EXPECT_TRUE(is_red(pixel(open, 200, 200)));
}

// A ball of so many triangles that they are drawn one by one on the processor.
TriangleMesh fine_ball(double r) {
  TriangleMesh out;
  constexpr unsigned rings = 120, around = 240;
  for (unsigned i = 1; i < rings; ++i)
    for (unsigned j = 0; j < around; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / around;
      out.vertices.emplace_back(r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b),
                                r * std::cos(a));
    }
  out.vertices.emplace_back(0, 0, r);
  out.vertices.emplace_back(0, 0, -r);
  const unsigned top = (rings - 1) * around, end = top + 1;
  for (unsigned j = 0; j < around; ++j) {
    const unsigned k = (j + 1) % around;
    out.triangles.push_back({top, j, k});
    for (unsigned i = 0; i + 2 < rings; ++i) {
      const unsigned a = i * around, b = a + around;
      out.triangles.push_back({a + j, b + j, b + k});
      out.triangles.push_back({a + j, b + k, a + k});
    }
    const unsigned last = (rings - 2) * around;
    out.triangles.push_back({end, last + k, last + j});
  }
  return out;
}

// With one triangle missing the mesh is open and drawn by OpenGL like any other.
TEST(Picture, DrawsSmallTrianglesAsItDrawsLargeOnes) {
  Renderer r = renderer(side, side);
  Scene scene = rich_scene();
  scene.bodies.push_back(body("ball", fine_ball(35), Vec3(-55, 20, 35)));
  scene.bodies.back().color = {170, 120, 60};
  for (const bool parallel : {false, true}) {
    Camera camera = rich_camera();
    if (parallel) camera.field_of_view = 0, camera.height = 260;
    const Image small = r.draw(scene, camera);
    Scene open = scene;
    TriangleMesh mesh = fine_ball(35);
    mesh.triangles.pop_back();  // at the ball's foot
    open.bodies.back() = body("ball", std::move(mesh), Vec3(-55, 20, 35));
    open.bodies.back().color = {170, 120, 60};
    const Image large = r.draw(open, camera);
    EXPECT_LT(mean_difference(small, large), 0.3);
    open.bodies.pop_back();
    EXPECT_GT(mean_difference(small, r.draw(open, camera)), 1.5);
  }
}

TEST(Picture, DrawsAGroundUnderSmallTrianglesAlone) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("ball", fine_ball(30))});
  scene.floor = true;
  const Image image = r.draw(scene, *camera_by_name("0,-300,90,0,0,0", Box3(), 1));
  EXPECT_GT(pixel(image, 10, 10)[0], 150);
  EXPECT_GT(pixel(image, 10, 390)[0], 150);
  const auto ball = pixel(image, 200, 190);
  EXPECT_GT(ball[0], 60);
  // Its shadow on the floor.
  int darkest = 255;
  for (int y = 250; y < 330; ++y)
    for (int x = 100; x < 300; ++x) darkest = std::min(darkest, pixel(image, x, y)[0]);
  EXPECT_LT(darkest + 15, pixel(image, 10, 300)[0]);
}

TEST(Picture, CutsBodiesOpenAndShowsThemFull) {
  Renderer r = renderer(side, side);
  // From the front: a post stands inside the walls of a box, which is cut away down to y = 0.
  TriangleMesh walls = block(100, 100, 100);
  const TriangleMesh room = block(80, 80, 80);
  for (const auto& t : room.triangles)  // turned round: a hollow
    walls.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  walls.vertices.insert(walls.vertices.end(), room.vertices.begin(), room.vertices.end());
  Scene scene = bare_scene({body("walls", std::move(walls)), body("post", block(20, 20, 80))});
  scene.bodies[0].color = {40, 90, 190};
  scene.bodies[1].color = {190, 60, 40};
  EXPECT_EQ(r.visible_pixels(scene, front_camera(200)).at(1), 0);
  scene.section = Section{Vec3(0, 0, 0), Vec3(0, -1, 0)};
  const auto counts = r.visible_pixels(scene, front_camera(200));
  EXPECT_NEAR(counts.at(1), 40 * 160, 200);
  EXPECT_NEAR(counts.at(0), 200 * 200 - 40 * 160, 500);
  const Image image = r.draw(scene, front_camera(200));
  const auto post = pixel(image, 200, 200), wall = pixel(image, 110, 200);
  EXPECT_GT(post[0], post[2] + 40);
  EXPECT_GT(wall[2], wall[0] + 40);
  // The face of the cut is one even surface: nothing of the far side's edges shows upon it.
  for (int y = 150; y < 250; ++y)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(image, 110, y)[c], wall[c], 8);
  // Lit as a wall that stands there would be.
  Scene solid = bare_scene({body("slab", block(100, 50, 100), Vec3(0, 25, 0))});
  solid.bodies[0].color = {40, 90, 190};
  const auto front = pixel(r.draw(solid, front_camera(200)), 110, 200);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(front[c], wall[c], 30);
}

TEST(Picture, MarksAContactEvenBehindABody) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("box", block(100, 100, 100))});
  const Image plain = r.draw(scene, front_camera(200));
  scene.markers = {{Vec3(20, 0, -10)}};  // inside; 2 pixels a mm: at 240, 220
  const Image marked = r.draw(scene, front_camera(200));
  EXPECT_TRUE(is_red(pixel(marked, 240, 220)));
  EXPECT_FALSE(is_red(pixel(plain, 240, 220)));
}

TEST(Picture, DrawsToolPathsInTheColourOfTheirKind) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({});
  scene.lines = {{LineKind::feed, {Vec3(-40, 0, 20), Vec3(40, 0, 20)}},
                 {LineKind::arc, {Vec3(-40, 0, -20), Vec3(40, 0, -20)}},
                 {LineKind::rapid, {Vec3(-40, 0, 0), Vec3(40, 0, 0)}}};
  const Image image = r.draw(scene, front_camera(200));
  const auto feed = pixel(image, 200, 160), arc = pixel(image, 200, 240);
  EXPECT_GT(feed[2], feed[0] + 60);
  EXPECT_GT(arc[1], arc[0] + 40);
  int on = 0;
  for (int x = 125; x < 275; ++x) {
    const auto c = pixel(image, x, 200);
    on += c[0] > c[2] + 60 ? 1 : 0;
  }
  EXPECT_GT(on, 60);   // dashes …
  EXPECT_LT(on, 120);  // … with gaps
}

TEST(Picture, KeepsAFaintTraceOfAPathInsideABody) {
  Renderer r = renderer(side, side);
  Scene scene = bare_scene({body("box", block(100, 100, 100))});
  scene.bodies[0].color = {200, 200, 200};
  const Image plain = r.draw(scene, front_camera(200));
  scene.lines = {{LineKind::feed, {Vec3(-40, 0, 20), Vec3(40, 0, 20)}}};
  const Image image = r.draw(scene, front_camera(200));
  const int fainter = pixel(plain, 200, 160)[0] - pixel(image, 200, 160)[0];
  EXPECT_GT(fainter, 8);
  EXPECT_LT(fainter, 90);
}

TEST(Picture, IsDrawnInTilesWithoutASeam) {
  // 2600 pixels take two tiles; the same view in 1300 takes one.
  const Scene scene = [] {
    Scene out = rich_scene();
    out.caption = {};
    out.markers.clear();
    out.lines.clear();
    out.triad = false;
    return out;
  }();
  const Box3 box(Vec3(-100, -60, -20), Vec3(100, 60, 120));
  const Camera camera = *camera_by_name("front", box, 4);
  const Image large = renderer(2600, 650).draw(scene, camera);
  const Image small = renderer(1300, 325).draw(scene, camera);
  ASSERT_EQ(large.width, 2600);
  Image shrunk = small;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int k = 0; k < 4; ++k) sum += pixel(large, 2 * x + k % 2, 2 * y + k / 2)[c];
        shrunk.rgba[(static_cast<std::size_t>(y) * 1300 + static_cast<std::size_t>(x)) * 4 + c] =
            static_cast<unsigned char>(sum / 4);
      }
  EXPECT_LT(mean_difference(shrunk, small), 3.0);
}

TEST(Picture, SurvivesScenesThatHaveNothingToShow) {
  Renderer r = renderer(64, 48);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  EXPECT_EQ(r.draw(scene, Camera{}).width, 64);
  scene.bodies.resize(2);  // no mesh
  scene.bodies[1] = body("lost", block(1, 1, 1), Vec3(nan, 0, 0));
  scene.bodies.push_back(body("empty", TriangleMesh{}));
  scene.lines = {{LineKind::feed, {Vec3(nan, 0, 0), Vec3(1, 1, 1)}}, {LineKind::arc, {}}};
  scene.markers = {{Vec3(0, nan, 0)}};
  EXPECT_EQ(r.draw(scene, Camera{}).height, 48);
  EXPECT_EQ(r.visible_pixels(scene, Camera{}), (std::vector<int>{0, 0, 0}));
}

TEST(Picture, SurvivesACameraInsideABody) {
  Renderer r = renderer(64, 48);
  const Scene scene = bare_scene({body("box", block(100, 100, 100))});
  Camera camera;
  camera.eye = Vec3::Zero();
  camera.target = Vec3(0, 10, 0);
  EXPECT_EQ(r.draw(scene, camera).width, 64);
}

TEST(Picture, RefusesASizeThatCannotBeDrawn) {
  for (const FrameSize size : {FrameSize{0, 100}, FrameSize{100, -1}, FrameSize{20000, 10},
                               FrameSize{10000, 10, Supersample::twice}}) {
    const auto made = Renderer::create(size);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, "output_failed");
  }
  EXPECT_TRUE(Renderer::create({1, 1}));
}

TEST(Picture, MayBeSupersampled) {
  auto fine = Renderer::create({320, 200, Supersample::twice});
  ASSERT_TRUE(fine);
  const Image twice = fine->draw(rich_scene(), rich_camera());
  const Image once = renderer(320, 200).draw(rich_scene(), rich_camera());
  EXPECT_EQ(twice.width, 320);
  EXPECT_LT(mean_difference(twice, once), 5.0);
}

}  // namespace
}  // namespace aircut::render
