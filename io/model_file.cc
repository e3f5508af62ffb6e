#include "ibrdf/io/model_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/checksum.h"

namespace ibrdf {
namespace {

constexpr char kMagic[] = "ibrdf-model ";
// The second one's fits have a Lambertian lobe.
constexpr int kVersion = 3, kLambertianVersion = 4;
constexpr size_t kMaxModelBytes = size_t{256} << 20;
// Rounding of a code that was projected to the unit sphere in float.
constexpr double kBallSlack = 1e-4;

// Takes the text up to the next newline off `rest`.
bool TakeLine(const std::string& bytes, size_t* at, std::string* line) {
  const size_t end = bytes.find('\n', *at);
  if (end == std::string::npos || end - *at > 64) return false;
  *line = bytes.substr(*at, end - *at);
  *at = end + 1;
  return true;
}

bool TakeFloats(const std::string& bytes, size_t* at, size_t count,
                std::vector<float>* values) {
  values->resize(count);
  if (count == 0) return true;  // memcpy takes no null pointer
  std::memcpy(values->data(), bytes.data() + *at, count * sizeof(float));
  *at += count * sizeof(float);
  for (const float v : *values) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

// -1 for what is no whole number in [0, INT_MAX]; get<int>() would wrap it into
// the valid range. FlowShape::Validate refuses negative sizes.
int IntOf(const nlohmann::json& value) {
  if (!value.is_number_integer()) return -1;
  const int64_t number = value.get<int64_t>();  // 2^63 and above: negative
  return number >= 0 && number <= std::numeric_limits<int>::max()
             ? static_cast<int>(number)
             : -1;
}

std::vector<int> IntsOf(const nlohmann::json& list) {
  if (!list.is_array()) return {-1};
  std::vector<int> out;
  for (const nlohmann::json& value : list) out.push_back(IntOf(value));
  return out;
}

Status ParseModelHeader(const std::string& path, const std::string& text,
                        NeuralBrdfModel* model) {
  try {
    const nlohmann::json header = nlohmann::json::parse(text);
    const std::string flow = header.at("flow").get<std::string>();
    if (flow == "triangular") {
      TriangularShape& shape = model->shape.triangular;
      // As a vector first: an array would take the first three of more.
      const std::vector<int> bins = IntsOf(header.at("bins"));
      if (bins.size() != shape.bins.size()) {
        return InvalidInput(path + ": bins", "expected 3 numbers, found " +
                                                 std::to_string(bins.size()));
      }
      std::copy(bins.begin(), bins.end(), shape.bins.begin());
      shape.code_size = IntOf(header.at("code_size"));
      shape.widths = IntsOf(header.at("widths"));
      shape.marginal_widths = IntsOf(header.at("marginal_widths"));
    } else if (flow == "coupling") {
      model->shape.architecture = FlowArchitecture::kCoupling;
      CouplingShape& shape = model->shape.coupling;
      shape.layers = IntOf(header.at("layers"));
      shape.bins = IntOf(header.at("bins"));
      shape.code_size = IntOf(header.at("code_size"));
      shape.widths = IntsOf(header.at("widths"));
    } else {
      return InvalidInput(path + ": flow",
                          "expected triangular or coupling, found " + flow);
    }
    model->exponent = header.at("exponent").get<double>();
    model->names = header.at("names").get<std::vector<std::string>>();
    model->note = header.at("note").get<std::string>();
    model->fit_lobes = IntOf(header.at("fit_lobes"));
  } catch (const nlohmann::json::exception& e) {
    return InvalidInput(path + ": header", e.what());
  }
  const std::string wrong = model->shape.Validate();
  if (!wrong.empty()) return InvalidInput(path + ": header", wrong);
  const int least_fit_lobes = model->fit_lambertian ? 1 : 0;
  if (model->fit_lobes < least_fit_lobes || model->fit_lobes > 8) {
    return InvalidInput(
        path + ": fit_lobes",
        "expected " + std::to_string(least_fit_lobes) + " to 8");
  }
  if (!(model->exponent >= 0.1 && model->exponent <= 32.0)) {
    return InvalidInput(path + ": exponent", "expected a number in [0.1, 32]");
  }
  return OkStatus();
}

}  // namespace

StatusOr<NeuralBrdfModel> ReadModel(const std::string& path) {
  const StatusOr<std::string> file = ReadFile(path, kMaxModelBytes);
  if (!file.ok()) return file.status();
  return DecodeModel(path, *file);
}

StatusOr<NeuralBrdfModel> DecodeModel(const std::string& path,
                                      const std::string& bytes) {
  const size_t magic = sizeof(kMagic) - 1;
  size_t at = magic;
  std::string version, length;
  if (bytes.compare(0, magic, kMagic) != 0 || !TakeLine(bytes, &at, &version)) {
    return InvalidInput(path,
                        "not a model file, expected \"ibrdf-model 3\" or 4");
  }
  const bool lambertian = version == std::to_string(kLambertianVersion);
  if (!lambertian && version != std::to_string(kVersion)) {
    return InvalidInput(path + ": version",
                        "expected 3 or 4, found " + version);
  }
  if (bytes.size() < at + sizeof(uint64_t)) {
    return InvalidInput(path, "truncated model file");
  }
  const size_t end = bytes.size() - sizeof(uint64_t);
  uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + end, sizeof(checksum));
  if (checksum != Fnv1a(bytes.data(), end)) {
    return InvalidInput(path + ": checksum",
                        "does not match, the file is damaged or truncated");
  }
  if (!TakeLine(bytes, &at, &length) || length.empty() || length.size() > 9 ||
      length.find_first_not_of("0123456789") != std::string::npos ||
      std::stoul(length) > end - at) {
    return InvalidInput(path + ": header", "expected its length in bytes");
  }
  const size_t header_size = std::stoul(length);
  NeuralBrdfModel model;
  model.fit_lambertian = lambertian;
  IBRDF_RETURN_IF_ERROR(
      ParseModelHeader(path, bytes.substr(at, header_size), &model));
  at += header_size;
  const size_t codes = model.names.size() * model.shape.code_size();
  const size_t fits =
      static_cast<size_t>(model.num_materials()) * model.fit_size();
  const size_t floats =
      model.shape.NumWeights() + codes + model.names.size() + fits;
  if (end - at != floats * sizeof(float)) {
    return InvalidInput(path, "expected " + std::to_string(floats) +
                                  " numbers after the header, found " +
                                  std::to_string((end - at) / sizeof(float)));
  }
  if (!TakeFloats(bytes, &at, model.shape.NumWeights(), &model.weights)) {
    return InvalidInput(path + ": weights", "expected finite numbers");
  }
  if (!TakeFloats(bytes, &at, codes, &model.codes)) {
    return InvalidInput(path + ": codes", "expected finite numbers");
  }
  if (!TakeFloats(bytes, &at, model.names.size(), &model.log_colours)) {
    return InvalidInput(path + ": log_colours", "expected finite numbers");
  }
  if (!TakeFloats(bytes, &at, fits, &model.lobe_fits)) {
    return InvalidInput(path + ": lobe_fits", "expected finite numbers");
  }
  for (int i = 0; i < model.num_codes(); ++i) {
    double sum = 0.0;
    for (int k = 0; k < model.shape.code_size(); ++k) {
      const double v = model.codes[i * model.shape.code_size() + k];
      sum += v * v;
    }
    if (std::sqrt(sum) > 1.0 + kBallSlack) {
      return InvalidInput(path + ": codes",
                          model.names[i] + " lies outside the unit ball");
    }
  }
  return model;
}

Status WriteModel(const NeuralBrdfModel& model, const std::string& path) {
  nlohmann::json header = {{"code_size", model.shape.code_size()},
                           {"exponent", model.exponent},
                           {"fit_lobes", model.fit_lobes},
                           {"names", model.names},
                           {"note", model.note}};
  if (model.shape.architecture == FlowArchitecture::kTriangular) {
    header["flow"] = "triangular";
    header["bins"] = model.shape.triangular.bins;
    header["widths"] = model.shape.triangular.widths;
    header["marginal_widths"] = model.shape.triangular.marginal_widths;
  } else {
    header["flow"] = "coupling";
    header["layers"] = model.shape.coupling.layers;
    header["bins"] = model.shape.coupling.bins;
    header["widths"] = model.shape.coupling.widths;
  }
  // A name may come from a file whose name is not UTF-8: replaced, not thrown.
  const std::string text =
      header.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const int version = model.fit_lambertian ? kLambertianVersion : kVersion;
  std::string bytes = kMagic + std::to_string(version) + "\n" +
                      std::to_string(text.size()) + "\n" + text;
  for (const std::vector<float>* values :
       {&model.weights, &model.codes, &model.log_colours, &model.lobe_fits}) {
    bytes.append(reinterpret_cast<const char*>(values->data()),
                 values->size() * sizeof(float));
  }
  const uint64_t checksum = Fnv1a(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
  return WriteFileAtomically(path, bytes);
}

StatusOr<std::string> FindModel(const std::string& name) {
  if (name != "default" && name != "broad") return name;
  std::vector<std::string> folders;
  if (const char* folder = std::getenv("IBRDF_MODEL_DIR")) {
    folders.push_back(folder);
  }
  folders.push_back(IBRDF_INSTALLED_MODEL_DIR);
  folders.push_back(IBRDF_SOURCE_MODEL_DIR);
  for (const std::string& folder : folders) {
    const std::string path = folder + "/" + name + ".ibrdf";
    struct stat info = {};
    if (::stat(path.c_str(), &info) == 0) return path;
  }
  return InvalidInput("reflectance.model",
                      "the " + name + " model is not installed, expected " +
                          name + ".ibrdf in $IBRDF_MODEL_DIR");
}

std::array<std::string, 2> ModelsOfFolder(const std::string& folder) {
  return {folder + "/default.ibrdf", folder + "/broad.ibrdf"};
}

}  // namespace ibrdf
