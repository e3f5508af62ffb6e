// Codes and log colours of a sum of coloured lobes.
#pragma once
#include <Eigen/Core>
#include <cstddef>

namespace ibrdf {

// Largest log colour that exp() is taken of. Colours beyond come of a step that
// went too far and are clamped, so that nothing overflows.
inline constexpr double kMaxLogColour = 40.0;

// Colour in 1/sr of a log colour in raw MERL units,
//   exp(min(log_colour, kMaxLogColour)) kMerlScale[channel],
// and the same in raw MERL units, without the scale.
double LobeColour(double log_colour, int channel);
double RawLobeColour(double log_colour);

// Where the numbers of a mixture lie, one lobe after the other: of lobe k the
// code z_k [code_size], then the log colours a_k [3]. The last lobe may be
// Lambertian: it has log colours alone.
struct LobeLayout {
  int num_lobes = 0, code_size = 0;  // the Lambertian lobe is counted
  bool lambertian = false;           // whether the last lobe is; num_lobes >= 1

  // The layout of as many lobes as the parameters make. Where codes have
  // numbers, three parameters too many are a Lambertian lobe's.
  static LobeLayout OfSize(size_t num_parameters, int code_size) {
    const int size = LobeLayout{1, code_size}.lobe_size();
    const int coded = static_cast<int>(num_parameters) / size;
    const bool lambertian = static_cast<int>(num_parameters) % size == 3;
    return {coded + (lambertian ? 1 : 0), code_size, lambertian};
  }
  // The same with a Lambertian lobe beside the others.
  LobeLayout WithLambertian() const {
    return lambertian ? *this : LobeLayout{num_lobes + 1, code_size, true};
  }

  // Lobes that have a code: the first ones.
  int num_coded() const { return num_lobes - (lambertian ? 1 : 0); }
  int code_size_of(int k) const { return k < num_coded() ? code_size : 0; }
  // Numbers of a lobe with a code.
  int lobe_size() const { return code_size + 3; }
  int num_parameters() const {
    return num_coded() * lobe_size() + (lambertian ? 3 : 0);
  }
  // Index of the first number of lobe k's code, and of its log colours.
  int code(int k) const { return k * lobe_size(); }
  int log_colour(int k) const { return code(k) + code_size_of(k); }

  bool operator==(const LobeLayout& other) const {
    return num_lobes == other.num_lobes && code_size == other.code_size &&
           lambertian == other.lambertian;
  }
};

// A view of parameters [num_parameters] that another owns: a block of Ceres, or
// anything with a number for each of them, such as a gradient. It does not
// outlive them.
class LobeMixture {
 public:
  LobeMixture(const LobeLayout& layout, const double* parameters)
      : layout_(layout), parameters_(parameters) {}

  const LobeLayout& layout() const { return layout_; }
  int num_lobes() const { return layout_.num_lobes; }

  // Empty for a Lambertian lobe.
  Eigen::Map<const Eigen::VectorXd> code(int k) const {
    return {parameters_ + layout_.code(k), layout_.code_size_of(k)};
  }
  Eigen::Map<const Eigen::Array3d> log_colour(int k) const {
    return Eigen::Map<const Eigen::Array3d>(parameters_ +
                                            layout_.log_colour(k));
  }
  // Code and log colours together.
  Eigen::Map<const Eigen::VectorXd> lobe(int k) const {
    return {parameters_ + layout_.code(k), layout_.code_size_of(k) + 3};
  }

  // LobeColour and RawLobeColour of all lobes, [channel, lobe].
  Eigen::Array3Xd Colours() const;
  Eigen::Array3Xd RawColours() const;
  // Derivatives of Colours by the log colours: the same, but 0 where clamped.
  Eigen::Array3Xd ColourSlopes() const;

 private:
  LobeLayout layout_;
  const double* parameters_;
};

// A view through which parameters are also written.
class MutableLobeMixture : public LobeMixture {
 public:
  MutableLobeMixture(const LobeLayout& layout, double* parameters)
      : LobeMixture(layout, parameters), parameters_(parameters) {}

  Eigen::Map<Eigen::VectorXd> code(int k) const {
    return {parameters_ + layout().code(k), layout().code_size_of(k)};
  }
  Eigen::Map<Eigen::Array3d> log_colour(int k) const {
    return Eigen::Map<Eigen::Array3d>(parameters_ + layout().log_colour(k));
  }
  Eigen::Map<Eigen::VectorXd> lobe(int k) const {
    return {parameters_ + layout().code(k), layout().code_size_of(k) + 3};
  }

  // Adds to the log colours of every lobe.
  void ShiftColours(const Eigen::Array3d& shift) const;
  // Codes outside the unit ball become unit vectors.
  void ClampCodes() const;

 private:
  double* parameters_;
};

}  // namespace ibrdf
