#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/convert_map.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "ibrdf/solvers/report/write_results.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/support/markup.h"
#include "tests/support/solver_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A folder with an image of 12x10, its mask, a model and a problem file.
class SolveProblemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Image image(12, 10);
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      image.rgb[i] = static_cast<float>(1.0 + 0.5 * std::sin(0.1 * i));
    }
    ASSERT_TRUE(WriteExr(image, dir_.File("input.exr")).ok());
    ASSERT_TRUE(WriteExr(SmoothMap(8, 16), dir_.File("truth.exr")).ok());
    WriteMask("mask.png", 12, 10);
    ASSERT_TRUE(WriteModel(TinyModel(2), dir_.File("tiny.ibrdf")).ok());
    WriteBytes(dir_.File("joint.yaml"),
               "problem: joint\n"
               "image: {file: input.exr, mask: mask.png}\n"
               "geometry: {sphere: {}}\n"
               "reflectance: {model: tiny.ibrdf, lobes: 2}\n"
               "illumination: {width: 16, height: 8, prior: none}\n"
               "solver: {seconds: 10, max_iterations: 1}\n"
               "truth: {illumination: truth.exr}\n");
  }
  // White but for the last column.
  void WriteMask(const std::string& name, int width, int height) const {
    Rgb8Image mask(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x + 1 < width; ++x) {
        for (int c = 0; c < 3; ++c) {
          mask.rgb[3 * (static_cast<size_t>(y) * width + x) + c] = 255;
        }
      }
    }
    ASSERT_TRUE(WritePng(mask, dir_.File(name)).ok());
  }
  StatusOr<InverseProblem> Load(const std::vector<std::string>& overrides) {
    const StatusOr<Problem> problem =
        ReadProblem(dir_.File("joint.yaml"), overrides);
    if (!problem.ok()) return problem.status();
    problem_ = *problem;
    return LoadInverseProblem(problem_, 5, 1);
  }
  Status Write(const InverseProblem& inverse, const Solution& solution,
               const std::string& folder,
               std::vector<std::string>* metric_lines = nullptr) const {
    const Truth truth = LoadTruth(problem_.truth, 16, 8).value();
    const StatusOr<ResultMetrics> metrics =
        MeasureResult(inverse, truth, solution);
    if (!metrics.ok()) return metrics.status();
    if (metric_lines != nullptr) *metric_lines = MetricLines(*metrics);
    return WriteResults({problem_, inverse, truth, solution, *metrics}, folder);
  }
  void ExpectRefused(const std::vector<std::string>& overrides,
                     const std::string& word) {
    const Status s = Load(overrides).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << word;
    EXPECT_NE(std::string::npos, s.message().find(word)) << s.message();
    EXPECT_EQ(std::string::npos, s.message().find('\n'));
  }

  const TempDir dir_;
  Problem problem_;
};

TEST_F(SolveProblemTest, LoadsWhatTheFileNames) {
  const StatusOr<InverseProblem> p = Load({});
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_EQ(ProblemKind::kJoint, p->kind);
  EXPECT_EQ(12, p->image.width);
  EXPECT_EQ(10, p->image.height);
  EXPECT_EQ(6, p->model->num_codes());
  EXPECT_EQ(uint64_t{5}, p->seed);
  EXPECT_FALSE(p->known_map.has_value());
  EXPECT_FALSE(p->known_brdf.has_value());
  ASSERT_FALSE(p->points.empty());
  for (const ShadingPoint& point : p->points) EXPECT_NE(11, point.pixel % 12);
  EXPECT_EQ(uint64_t{9}, Load({"solver.seed=9"})->seed);
  EXPECT_EQ(8, Load({"illumination={unet_channels: 8}"})->unet_channels);
}

TEST_F(SolveProblemTest, QuadratureLevelsAreOfOrderedCostAndTheSameLight) {
  // Half-vectors and cells of the sphere by level, of the same integral.
  double before = 0.0, least = 1e300, most = 0.0;
  for (const std::string level : {"coarse", "standard", "fine"}) {
    const StatusOr<InverseProblem> p =
        Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}",
              "illumination={width: 128}", "solver.quadrature=" + level});
    ASSERT_TRUE(p.ok()) << p.status().message();
    const Transport transport(p->points, 64, 128, p->transport);
    const auto bytes = static_cast<double>(transport.MemoryBytes());
    EXPECT_GT(bytes, 1.5 * before) << level;
    before = bytes;
    const Image map = testing::SmoothMap(64, 128);
    std::vector<double> L_o(3 * p->points.size());
    transport.Render(*p->known_brdf, map.rgb.data(), L_o.data());
    const double sum = std::accumulate(L_o.begin(), L_o.end(), 0.0);
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  EXPECT_LT(most, 1.003 * least);
  EXPECT_GT(most, least);
}

TEST_F(SolveProblemTest, KnownPartsAreLoadedAtTheProblemsSize) {
  const StatusOr<InverseProblem> p =
      Load({"problem=reflectance",
            "illumination={known: truth.exr, width: 8, height: 4}"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  ASSERT_TRUE(p->known_map.has_value());
  EXPECT_EQ(8, p->map_width);
  EXPECT_EQ(4, p->map_height);
  EXPECT_EQ(p->map_width, p->known_map->width);
  EXPECT_EQ(p->map_height, p->known_map->height);
  const StatusOr<InverseProblem> q =
      Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}"});
  if (q.ok()) {
    ASSERT_TRUE(q->known_brdf.has_value());
    EXPECT_NEAR(0.5 / kPi, q->known_brdf->values[0], 1e-5);
  } else {
    ADD_FAILURE() << q.status().message();
  }
}

// Where no size is asked for: the map's own, to a power of two.
TEST_F(SolveProblemTest, KnownMapsKeepTheirDetail) {
  ASSERT_TRUE(WriteExr(SmoothMap(150, 300), dir_.File("fine.exr")).ok());
  ASSERT_TRUE(WriteExr(SmoothMap(400, 800), dir_.File("finest.exr")).ok());
  WriteBytes(dir_.File("cube.obj"),
             "v -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nv 0 0 1\n"
             "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const struct {
    std::string map, geometry, effects;
    int width;
  } cases[] = {{"truth.exr", "{sphere: {}}", "auto", 128},
               {"fine.exr", "{sphere: {}}", "auto", 256},
               {"finest.exr", "{sphere: {}}", "auto", 256},
               {"fine.exr", "{mesh: cube.obj}", "[visibility]", 128}};
  for (const auto& c : cases) {
    const StatusOr<InverseProblem> p =
        Load({"problem=reflectance", "geometry=" + c.geometry,
              "effects=" + c.effects, "illumination={known: " + c.map + "}"});
    ASSERT_TRUE(p.ok()) << p.status().message();
    EXPECT_EQ(c.effects != "auto", p->transport.visibility != nullptr);
    EXPECT_EQ(c.width, p->map_width) << c.map << " " << c.geometry;
    EXPECT_EQ(c.width / 2, p->map_height);
    EXPECT_EQ(c.width, p->known_map->width);
    EXPECT_EQ(c.width / 2, p->known_map->height);
  }
}

TEST_F(SolveProblemTest, MissingFilesAreNamed) {
  ExpectRefused({"image.file=nowhere.exr"}, "nowhere.exr");
  ExpectRefused({"image.mask=nomask.png"}, "nomask.png");
  ExpectRefused({"reflectance.model=nomodel.ibrdf"}, "nomodel.ibrdf");
  ExpectRefused({"geometry={mesh: nomesh.obj}"}, "nomesh.obj");
  ExpectRefused({"problem=illumination", "reflectance={known: no.binary}"},
                "no.binary");
  ExpectRefused({"problem=reflectance", "illumination={known: no.exr}"},
                "no.exr");
}

TEST_F(SolveProblemTest, MaskOfAnotherSizeIsRefused) {
  WriteMask("small.png", 11, 10);
  ExpectRefused({"image.mask=small.png"}, "12x10");
}

// No transport takes so many cells.
TEST_F(SolveProblemTest, MapsWhoseSidesDoNotHalveAreRefused) {
  ExpectRefused({"illumination={width: 510, height: 255}"},
                "illumination.width");
  ExpectRefused(
      {"problem=reflectance", "illumination={known: truth.exr, width: 510}"},
      "found 510x255");
  EXPECT_TRUE(Load({"illumination={width: 512}"}).ok());
  EXPECT_TRUE(Load({"illumination={width: 250}"}).ok());
}

TEST_F(SolveProblemTest, EmptyMaskIsRefused) {
  WriteMask("one.png", 12, 10);
  ASSERT_TRUE(WritePng(Rgb8Image(12, 10), dir_.File("black.png")).ok());
  ExpectRefused({"image.mask=black.png"}, "");
}

TEST_F(SolveProblemTest, ModelWithoutCodesIsRefused) {
  ASSERT_TRUE(WriteModel(TinyModel(0), dir_.File("bare.ibrdf")).ok());
  ExpectRefused({"reflectance.model=bare.ibrdf"}, "bare.ibrdf");
}

TEST_F(SolveProblemTest, ResultsAreWholeAndReadBack) {
  const StatusOr<InverseProblem> p = Load({});
  ASSERT_TRUE(p.ok()) << p.status().message();
  InverseProblem inverse = *p;
  inverse.transport = TinyTransportOptions();
  const StatusOr<Solution> e = SolveInverseRendering(inverse, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  const std::string out = dir_.File("out/deep");
  std::vector<std::string> lines;
  const Status written = Write(inverse, *e, out, &lines);
  ASSERT_TRUE(written.ok()) << written.message();

  const char* names[] = {"result.json",      "brdf.binary", "brdf.json",
                         "illumination.exr", "render.exr",  "residual.exr",
                         "overview.png",     "render.png",  "residual.png",
                         "illumination.png", "brdf.png",    "input.png",
                         "report.html"};
  for (const char* name : names) {
    EXPECT_TRUE(std::filesystem::exists(out + "/" + name)) << name;
  }
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    // Nothing temporary is left.
    const std::string ext = entry.path().extension();
    EXPECT_TRUE(ext == ".json" || ext == ".binary" || ext == ".exr" ||
                ext == ".png" || ext == ".html")
        << entry.path();
  }
  EXPECT_EQ(e->brdf.raw, ReadMerl(out + "/brdf.binary")->raw);
  EXPECT_EQ(16, ReadImage(out + "/illumination.exr")->width);
  EXPECT_EQ(12, ReadImage(out + "/render.exr")->width);

  const nlohmann::json result =
      nlohmann::json::parse(ReadBytes(out + "/result.json"));
  for (const char* key : {"status", "problem", "effects", "metrics", "trace"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  for (const char* key : {"seconds", "misfit", "illumination_relative_log_rmse",
                          "illumination_relative_log_rmse_aligned"}) {
    EXPECT_TRUE(result["metrics"].contains(key)) << key;
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
      return line.rfind(std::string(key) + " ", 0) == 0;
    })) << key;
  }
  EXPECT_FALSE(result["metrics"].contains("brdf_log_rmse"));  // no truth given
  ASSERT_EQ(e->trace.size(), result["trace"].size());
  for (const char* key : {"seconds", "cost", "likelihood", "reflectance_prior",
                          "illumination_prior"}) {
    EXPECT_TRUE(result["trace"][0].contains(key)) << key;
  }
  EXPECT_EQ(e->misfit, result["metrics"]["misfit"].get<double>());

  const std::string page = ReadBytes(out + "/report.html");
  EXPECT_EQ("", MarkupError(page));
  EXPECT_NE(std::string::npos, page.find("joint.yaml"));

  const nlohmann::json brdf =
      nlohmann::json::parse(ReadBytes(out + "/brdf.json"));
  ASSERT_EQ(size_t{2}, brdf["lobes"].size());
  for (int k = 0; k < 2; ++k) {
    for (int d = 0; d < 4; ++d) {
      EXPECT_EQ(e->lobe_parameters[7 * k + d],
                brdf["lobes"][k]["code"][d].get<double>());
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_DOUBLE_EQ(std::exp(e->lobe_parameters[7 * k + 4 + c]),
                       brdf["lobes"][k]["colour_raw_merl"][c].get<double>());
    }
  }
}

TEST_F(SolveProblemTest, MapsAreWrittenInTheOutputFrameAndReadBack) {
  for (const MapFrame frame : kMapFrames) {
    const std::string word = MapFrameName(frame);
    const StatusOr<InverseProblem> p =
        Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}",
              "solver.max_iterations=0", "illumination.output_frame=" + word});
    ASSERT_TRUE(p.ok()) << p.status().message();
    StatusOr<Solution> e = SolveInverseRendering(*p, nullptr, nullptr);
    ASSERT_TRUE(e.ok()) << e.status().message();
    e->map = SmoothMap(8, 16);
    e->map_std = SmoothMap(4, 8);
    const std::string out = dir_.File("out_" + word);
    const Status written = Write(*p, *e, out);
    ASSERT_TRUE(written.ok()) << written.message();
    const nlohmann::json result =
        nlohmann::json::parse(ReadBytes(out + "/result.json"));
    EXPECT_EQ(word, result["illumination_frame"]);
    for (const auto& [file, map] :
         {std::pair("/illumination.exr", e->map),
          std::pair("/illumination_log_std.exr", e->map_std)}) {
      const StatusOr<StoredMap> stored =
          ReadStoredMap(out + file, std::nullopt);
      ASSERT_TRUE(stored.ok()) << stored.status().message();
      EXPECT_EQ(frame, stored->frame);
      EXPECT_EQ(FromLibraryFrame("map", map, frame)->rgb, stored->image.rgb)
          << word << file;
    }
  }
}

// The estimated map of a solve, known to the next: the same light.
TEST_F(SolveProblemTest, AnEstimatedMapIsTheSameLightWhenItIsKnown) {
  const StatusOr<InverseProblem> p =
      Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  const StatusOr<Solution> e = SolveInverseRendering(*p, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  const std::string out = dir_.File("out");
  ASSERT_TRUE(Write(*p, *e, out).ok());
  const StatusOr<InverseProblem> q =
      Load({"problem=reflectance",
            "illumination={known: out/illumination.exr, width: 16}"});
  ASSERT_TRUE(q.ok()) << q.status().message();
  EXPECT_EQ(p->warnings, q->warnings);
  EXPECT_EQ(e->map.rgb, q->known_map->rgb);
}

TEST_F(SolveProblemTest, TruthIsReadInItsFrame) {
  const Image map = SmoothMap(8, 16);
  ASSERT_TRUE(WriteMap(map, MapFrame::kCamera, dir_.File("mine.exr")).ok());
  TruthSpec truth;
  truth.illumination = dir_.File("mine.exr");
  EXPECT_EQ(map.rgb, LoadTruth(truth, 16, 8)->illumination.rgb);
  EXPECT_TRUE(LoadTruth(truth, 16, 8)->warnings.empty());
  truth.frame = MapFrame::kMitsuba;
  const StatusOr<Truth> turned = LoadTruth(truth, 16, 8);
  ASSERT_TRUE(turned.ok()) << turned.status().message();
  EXPECT_NE(map.rgb, turned->illumination.rgb);
  ASSERT_EQ(size_t{1}, turned->warnings.size());
  EXPECT_NE(std::string::npos,
            turned->warnings[0].find("ibrdf:frame says camera"));
}

TEST_F(SolveProblemTest, PosteriorSaysHowWellItIsConditioned) {
  const StatusOr<InverseProblem> p = Load({});
  ASSERT_TRUE(p.ok()) << p.status().message();
  InverseProblem inverse = *p;
  inverse.transport = TinyTransportOptions();
  inverse.solver.max_iterations = 0;
  StatusOr<Solution> e = SolveInverseRendering(inverse, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  const std::string out = dir_.File("out");
  const auto posterior = [&](std::vector<double> covariance) {
    e->lobe_covariance = std::move(covariance);
    const Status written = Write(inverse, *e, out);
    EXPECT_TRUE(written.ok()) << written.message();
    return nlohmann::json::parse(ReadBytes(out + "/result.json"))["posterior"];
  };
  EXPECT_FALSE(posterior({}).contains("condition_number"));
  const size_t n = e->lobe_parameters.size();
  std::vector<double> covariance(n * n, 0.0);
  for (size_t i = 0; i < n; ++i) covariance[i * n + i] = 1e-4 * (1.0 + i);
  // Two of correlation 1/2: eigenvalues 1/2 and 3/2.
  covariance[1] = covariance[n] =
      0.5 * std::sqrt(covariance[0] * covariance[n + 1]);
  EXPECT_NEAR(3.0, posterior(covariance)["condition_number"].get<double>(),
              1e-9);
}

TEST_F(SolveProblemTest, ResultsOfAKnownReflectanceHoldNoBrdf) {
  const StatusOr<InverseProblem> p =
      Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  InverseProblem inverse = *p;
  const StatusOr<Solution> e = SolveInverseRendering(inverse, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  const std::string out = dir_.File("out");
  std::filesystem::create_directories(out);
  for (const char* name :
       {"brdf.binary", "brdf.json", "brdf_128.binary", "brdf_0_255_7.json",
        "illumination_log_std.exr", "notes.txt", "brdf_old.binary"}) {
    WriteBytes(out + "/" + name, "of an earlier run");
  }
  ASSERT_TRUE(Write(inverse, *e, out).ok());
  EXPECT_TRUE(std::filesystem::exists(out + "/result.json"));
  EXPECT_TRUE(std::filesystem::exists(out + "/notes.txt"));
  EXPECT_TRUE(std::filesystem::exists(out + "/brdf_old.binary"));
  EXPECT_FALSE(std::filesystem::exists(out + "/brdf_128.binary"));
  EXPECT_FALSE(std::filesystem::exists(out + "/brdf_0_255_7.json"));
  EXPECT_FALSE(std::filesystem::exists(out + "/brdf.binary"));
  EXPECT_FALSE(std::filesystem::exists(out + "/brdf.json"));
  EXPECT_FALSE(std::filesystem::exists(out + "/illumination_log_std.exr"));
  // What the problem names is the user's.
  WriteBytes(out + "/brdf.binary", "the known table");
  problem_.reflectance.known_file = out + "/brdf.binary";
  ASSERT_TRUE(Write(inverse, *e, out).ok());
  EXPECT_TRUE(std::filesystem::exists(out + "/brdf.binary"));
}

// What speaks for a folder is not there before all that it speaks of.
TEST_F(SolveProblemTest, NothingOfAnEarlierRunSpeaksForTheNext) {
  const StatusOr<InverseProblem> p =
      Load({"problem=illumination", "reflectance={known: {lambertian: 0.5}}"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  const StatusOr<Solution> e = SolveInverseRendering(*p, nullptr, nullptr);
  ASSERT_TRUE(e.ok()) << e.status().message();
  const std::string out = dir_.File("out");
  std::filesystem::create_directories(out + "/render.exr/in_the_way");
  for (const char* name : {"result.json", "report.html"}) {
    WriteBytes(out + "/" + name, "of an earlier run");
  }
  ASSERT_FALSE(Write(*p, *e, out).ok());
  EXPECT_FALSE(std::filesystem::exists(out + "/result.json"));
  EXPECT_FALSE(std::filesystem::exists(out + "/report.html"));
  std::filesystem::remove_all(out + "/render.exr");
  const Status written = Write(*p, *e, out);
  ASSERT_TRUE(written.ok()) << written.message();
  EXPECT_TRUE(nlohmann::json::accept(ReadBytes(out + "/result.json")));
}

// A path need not be UTF-8; JSON and HTML must be.
TEST_F(SolveProblemTest, NamesInOtherEncodingsAreWritten) {
  const std::string file = dir_.File("b\xE4r.exr");
  std::filesystem::copy_file(dir_.File("input.exr"), file);
  const StatusOr<InverseProblem> p = Load({"solver.max_iterations=0"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  InverseProblem inverse = *p;
  inverse.transport = TinyTransportOptions();
  const StatusOr<Solution> e = SolveInverseRendering(inverse, nullptr, nullptr);
  ASSERT_TRUE(e.ok());
  problem_.image.file = file;
  const std::string out = dir_.File("out");
  ASSERT_TRUE(Write(inverse, *e, out).ok());
  EXPECT_TRUE(nlohmann::json::accept(ReadBytes(out + "/result.json")));
  EXPECT_NE(std::string::npos,
            ReadBytes(out + "/report.html").find("b\xEF\xBF\xBDr.exr"));
}

// What no metric can be taken against must be known before a solve.
TEST_F(SolveProblemTest, TruthThatCannotServeIsRefused) {
  const auto expect_refused = [](const TruthSpec& truth,
                                 const std::string& word) {
    const Status s = LoadTruth(truth, 16, 8).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << word;
    EXPECT_NE(std::string::npos, s.message().find(word)) << s.message();
  };
  EXPECT_TRUE(LoadTruth({}, 16, 8).ok());
  expect_refused({dir_.File("gone.binary"), "", {}}, "gone.binary");
  expect_refused({"", dir_.File("gone.exr"), {}}, "gone.exr");
  MerlTable nothing;
  nothing.raw.assign(size_t{3} * kMerlBins, -1.0);
  ASSERT_TRUE(WriteMerl(nothing, dir_.File("nothing.binary")).ok());
  expect_refused({dir_.File("nothing.binary"), "", {}}, "nothing.binary");
  ASSERT_TRUE(WriteExr(ConstantMap(8, 16, 2.0f), dir_.File("even.exr")).ok());
  expect_refused({"", dir_.File("even.exr"), {}}, "even.exr");
}

TEST_F(SolveProblemTest, FolderIsPreparedOrNamed) {
  EXPECT_TRUE(PrepareFolder(dir_.File("a/b")).ok());
  EXPECT_TRUE(std::filesystem::is_directory(dir_.File("a/b")));
  EXPECT_TRUE(PrepareFolder(dir_.File("a/b")).ok());
  const Status s = PrepareFolder(dir_.File("input.exr"));
  EXPECT_EQ(StatusCode::kInvalidInput, s.code());
  EXPECT_NE(std::string::npos, s.message().find("input.exr"));
}

TEST_F(SolveProblemTest, ResultsDoNotReplaceWhatTheProblemNames) {
  const std::string out = dir_.File("out");
  std::filesystem::create_directories(out);
  std::filesystem::copy_file(dir_.File("input.exr"), out + "/render.exr");
  std::filesystem::copy_file(dir_.File("mask.png"), out + "/brdf.png");
  std::filesystem::copy_file(dir_.File("truth.exr"), out + "/illumination.exr");
  WriteBytes(out + "/brdf.binary", "a table");
  const auto check = [&](const std::vector<std::string>& overrides) {
    const Problem problem =
        ReadProblem(dir_.File("joint.yaml"), overrides).value();
    return CheckNothingReplaced(
        problem, ResultPaths(problem, PhotographedObject(), out));
  };
  // Nor a photograph that another program's file names.
  const std::string view = ViewFolder(out, "left");
  ASSERT_TRUE(PrepareFolder(view).ok());
  std::filesystem::copy_file(dir_.File("input.exr"), view + "/render.exr");
  const Problem plain = ReadProblem(dir_.File("joint.yaml"), {}).value();
  EXPECT_TRUE(CheckNothingReplaced(plain, {view + "/render.exr"}).ok());
  EXPECT_NE(std::string::npos,
            CheckNothingReplaced(plain, {view + "/render.exr"},
                                 {{"view left", view + "/render.exr"}})
                .message()
                .find("view left: expected a file that no result replaces"));
  const struct {
    std::string key, file;
  } cases[] = {{"image.file", "render.exr"},
               {"image.mask", "brdf.png"},
               {"truth.illumination", "illumination.exr"},
               {"truth.brdf", "brdf.binary"}};
  for (const auto& c : cases) {
    const Status s = check({c.key + "=out/../out/" + c.file});
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << c.key;
    for (const std::string& word :
         {"joint.yaml: " + c.key, out + "/" + c.file}) {
      EXPECT_NE(std::string::npos, s.message().find(word)) << s.message();
    }
  }
  EXPECT_TRUE(check({}).ok());
  // The table of a known reflectance is read and not written.
  EXPECT_TRUE(
      check({"problem=illumination", "reflectance={known: out/brdf.binary}"})
          .ok());
}

TEST_F(SolveProblemTest, FolderThatCannotBeMadeIsNamed) {
  const StatusOr<InverseProblem> p = Load({"solver.max_iterations=0"});
  ASSERT_TRUE(p.ok());
  const StatusOr<Solution> e = SolveInverseRendering(*p, nullptr, nullptr);
  ASSERT_TRUE(e.ok());
  const std::string out = dir_.File("input.exr") + "/out";
  const Status s = Write(*p, *e, out);
  EXPECT_EQ(StatusCode::kInvalidInput, s.code());
  EXPECT_NE(std::string::npos, s.message().find(out));
}

}  // namespace
}  // namespace ibrdf
