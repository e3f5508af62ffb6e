// The likelihood of a reflectance with the light integrated out.
//
// The maximum over reflectance and light together prefers glossy reflectance
// under blurred light: such light is the more probable point of any smooth
// prior, though hardly any light looks like it. Integrated over all light that
// the prior allows, a reflectance pays for detail that it would show and the
// image lacks. (Blind deconvolution has the same trap and the same way out:
// Levin et al., "Understanding and evaluating blind deconvolution algorithms",
// CVPR 2009, Sec. 3.)
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/solvers/priors/light_process.h"
#include "ibrdf/solvers/priors/light_spectrum.h"

namespace ibrdf {

// The most probable log radiance of the light, m + l, and l = K representers.
// Sources are the map's texels, then directional lights.
struct LightMode {
  double level = 0.0;  // m, of all three channels
  // [3 * sources], channel by channel, then with paint its log albedo
  // [3 * points]; empty: none yet.
  Eigen::VectorXd l;
  Eigen::VectorXd representers;  // as l
};

// What separates an image from the radiance that a reflectance gives.
struct DataErrors {
  Eigen::VectorXd noise;  // diagonal of D [3 * points], > 0
  // The share of the radiance that paint scales, m [3 * points] in [0, 1], and
  // what the paint's mean adds to log radiance; empty where there is no paint.
  Eigen::VectorXd matte_share = {}, mean_paint = {};
};

// What an image says of log radiance [3 * points], channel by channel.
struct LogRadianceData {
  std::vector<double> value;
  // Ends of intervals, -infinity and infinity where there is none; both empty:
  // the value is known.
  std::vector<double> low, high;
};

struct MarginalGradient {
  std::array<RowMatrix, 3> matrices;  // [points][sources] each
  // By log amplitude and log roughness.
  std::array<double, LightHyperparameters::kCount> hyperparameters = {};
};

// What data say of n parameters and of the light around a mode, to first order
// (log L_o moves by G d + J l): a normal distribution.
struct LinearPosterior {
  Eigen::MatrixXd information;  // of the parameters, G^T A^-1 G [n]^2
  // The light's at fixed parameters: K - K J^T A^-1 J K [3 * sources]^2.
  RowMatrix light_covariance;
  // By how much the light's mean falls as parameters rise: K J^T A^-1 G
  // [3 * sources][n].
  RowMatrix light_slope;
};

struct MarginalValue {
  bool ok = false;    // false: not finite, or no mode was found
  double cost = 0.0;  // -log p(image | reflectance), nats, up to a constant
  // Mean |log L_o - log I| at the mode, I the nearest value of an interval. One
  // end alone that holds does not count.
  double misfit = 0.0;
};

// Laplace's approximation of -log of
//   integral N(y; log L_o(l), D) N(l; 0, K) dl,  L_o_c = T_c exp(m + l_c):
//   (y - log L_o)^T D^-1 (y - log L_o) / 2 + l^T K^-1 l / 2
//   + log det(D + J K J^T) / 2  at the mode of l,
// J = d log L_o / d l, in the space of the data, so that K needs no inverse.
//
// D is diagonal and the caller's, see NoiseVariance.
//
// With paint, log L_o is log(T exp(m + l)) + matte_share * a, a the log albedo
// of the points relative to their material's and to its prior mean a0: a ~ N(0,
// K_a) is integrated out with the light, as more of l. The share is held where
// it was found, so a is linear here, and A gets matte_share K_a matte_share.
// With u the share without paint, m = u e^a0 / (1 + u (e^a0 - 1)), and the mean
// adds log(1 + u (e^a0 - 1)) to log L_o.
//
// A datum of which an interval is known has -log of the probability that N(log
// L_o, D) lies in it in place of (y - log L_o)^2 / (2 D): IntervalLikelihood,
// whose slope takes the place of (y - log L_o) / D and whose curvature W that
// of 1 / D. Where it holds amply W is 0, so its rows enter scaled, W^1/2 J with
// 1 on the diagonal; the determinant of A = D + J K J^T is then that of such
// rows, and W moves with the light.
// Immutable; may be used from several threads.
class MarginalLikelihood {
 public:
  // paint: K_a [3 * points]^2, channel by channel, positive semidefinite;
  // empty: none. mean_paint: a0 [3 * points]; empty: 0.
  MarginalLikelihood(LogRadianceData data, const LightProcess& process,
                     int map_height, int map_width, int num_directional_lights,
                     int num_threads, Eigen::MatrixXd paint = {},
                     Eigen::VectorXd mean_paint = {});

  int num_points() const { return num_points_; }
  int num_texels() const { return map_height_ * map_width_; }
  int num_directional_lights() const { return num_directional_lights_; }
  int num_sources() const { return num_texels() + num_directional_lights_; }
  bool has_paint() const { return paint_.size() > 0; }
  // The latent variables of LightMode: the light's and, with paint, the
  // points'.
  Eigen::Index num_latents() const {
    return Eigen::Index{3} * num_sources() + (has_paint() ? y_.size() : 0);
  }

  // matrices: T_c [points][sources], >= 0, of the reflectance in channel c;
  // errors: with a matte share where there is paint; hyperparameters: of the
  // process. `mode` is where the search starts, if it holds one, and receives
  // the mode, found where another step would gain less than `tolerance` nats;
  // gradient may be null. The gradient is of the whole cost, the mode's own
  // motion included.
  MarginalValue Evaluate(const std::array<RowMatrix, 3>& matrices,
                         const DataErrors& errors,
                         const LightHyperparameters& hyperparameters,
                         double tolerance, LightMode* mode,
                         MarginalGradient* gradient) const;

  // The likelihood around a mode: its derivatives follow from this without
  // another search for the mode. The likelihood must outlive it.
  struct Expansion;

  // As Evaluate without a gradient. `expansion` receives the one around the
  // mode, null where the value is not ok. near: of another reflectance, at
  // `mode`; it tells how the mode moves from there, to first order; may be
  // null.
  MarginalValue Expand(std::array<RowMatrix, 3> matrices, DataErrors errors,
                       const LightHyperparameters& hyperparameters,
                       double tolerance, const Expansion* near, LightMode* mode,
                       std::unique_ptr<const Expansion>* expansion) const;
  // The gradient of Evaluate.
  MarginalGradient Gradient(const Expansion& at) const;

  // Gauss-Newton Hessian [n + hyperparameters]^2 of the cost by n parameters
  // and, last, by the hyperparameters, the light profiled out:
  //   G^T A^-1 G,  A = D + J K J^T,  G = d log L_o / d parameters [3 *
  //   points][n]
  // with the light held at its mode. Of the log determinant the hyperparameters
  // alone have their part in it, the Fisher information tr(A^-1 J K_a J^T A^-1
  // J K_b J^T) / 2, K_a the derivative of K by scale a. Positive semidefinite.
  // Empty where A is not positive definite. of_hyperparameters: their block,
  // which takes most of the time; one that is not empty is used as it is, an
  // empty one receives it.
  Eigen::MatrixXd Information(
      const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
      const LightHyperparameters& hyperparameters, const LightMode& mode,
      const RowMatrix& G, Eigen::MatrixXd* of_hyperparameters = nullptr) const;
  Eigen::MatrixXd Information(
      const Expansion& at, const RowMatrix& G,
      Eigen::MatrixXd* of_hyperparameters = nullptr) const;

  // The same and the light's part, without hyperparameters; G: as
  // Information's. Its matrices are empty where A is not positive definite.
  // CHECKs that there is no paint.
  LinearPosterior Linearised(const std::array<RowMatrix, 3>& matrices,
                             const DataErrors& errors,
                             const LightHyperparameters& hyperparameters,
                             const LightMode& mode, const RowMatrix& G) const;

  // J of a channel [points][sources] under the light of `mode`, whatever the
  // data say; without paint.
  std::array<RowMatrix, 3> LightJacobian(
      const std::array<RowMatrix, 3>& matrices, const LightMode& mode) const;

  // sigma^2 and what the map's coarse texels cannot hold: light inside a texel
  // shows where a lobe changes within it,
  //   sigma^2 + 1 / L_o_p^2 sum_t v_t L_t^2 sum_n (T_pt - T_pn)^2 / 8,
  // n the four neighbours of t, v the process' variance inside a texel at its
  // average hyperparameters, L and L_o = T L those of `mode`. Small for a matte
  // surface under soft light, v for a ray. A mirror is then not blamed for what
  // the map lacks, nor preferred for it. Were v to follow the estimated
  // hyperparameters, what they are taken for would be the noise that suits a
  // reflectance (experiments/evidence).
  Eigen::VectorXd NoiseVariance(const std::array<RowMatrix, 3>& matrices,
                                double sigma, const LightMode& mode) const;

  // The share of T L [3 * points] under the light of `mode` that is matte's,
  // the matrices of the part that paint scales, and what a0 makes of it.
  void SetPaint(const std::array<RowMatrix, 3>& matrices,
                const std::array<RowMatrix, 3>& matte, const LightMode& mode,
                DataErrors* errors) const;

  // NoiseVariance and, with paint, SetPaint where no mode is known yet: at
  // the one found, to `tolerance` nats, with independent deviations of 0.15 and
  // the share under constant light. matte: not read without paint. `mode` as in
  // Evaluate.
  DataErrors FindErrors(const std::array<RowMatrix, 3>& matrices,
                        const std::array<RowMatrix, 3>& matte, double sigma,
                        const LightHyperparameters& hyperparameters,
                        double tolerance, LightMode* mode) const;

  // The level at which constant light gives the image's mean log radiance.
  double LevelFor(const std::array<RowMatrix, 3>& matrices) const;

  // Diagonal of K, [3 * texels].
  Eigen::VectorXd PriorLightVariance(
      const LightHyperparameters& hyperparameters) const;
  // Diagonal of the posterior covariance of l [3 * texels] at the mode.
  Eigen::VectorXd LightVariance(const std::array<RowMatrix, 3>& matrices,
                                const DataErrors& errors,
                                const LightHyperparameters& hyperparameters,
                                const LightMode& mode) const;

  // Variances of linear functions of l, one a column of functions [texels][n],
  // each summed over channels [n]: of the prior, and of the posterior at the
  // mode.
  struct FunctionVariance {
    Eigen::VectorXd prior, posterior;
  };
  FunctionVariance LightFunctionVariance(
      const std::array<RowMatrix, 3>& matrices, const DataErrors& errors,
      const LightHyperparameters& hyperparameters, const LightMode& mode,
      const RowMatrix& functions) const;

 private:
  struct Point {
    Eigen::VectorXd L;          // radiance [3 * sources]
    Eigen::VectorXd unpainted;  // T L [3 * points]
    Eigen::VectorXd log_L_o;    // [3 * points]
    Eigen::VectorXd residual;   // y - log L_o, y the nearest of an interval
    bool Valid() const;         // finite, and not black
  };
  // What the data say at a point [3 * points].
  struct DataTerm {
    double cost = 0.0;
    Eigen::VectorXd slope;      // -d cost / d log L_o: residual / D
    Eigen::VectorXd curvature;  // W: 1 / D
    // d W / d log L_o of intervals; empty: of no datum.
    Eigen::VectorXd curvature_slope;
  };
  // The process at some hyperparameters.
  struct Light {
    double amplitude;
    LightSpectrum correlation;  // C
    LightSpectrum rough;        // its rough part
  };
  Light LightAt(const LightHyperparameters& hyperparameters) const;
  // What the search for a mode holds fixed.
  struct Given {
    const std::array<RowMatrix, 3>& matrices;  // T_c
    const Eigen::VectorXd& noise;              // D [3 * points]
    const Eigen::VectorXd& matte_share;        // [3 * points] or empty
    const Eigen::VectorXd& mean_paint;         // likewise
    Eigen::VectorXd weight;                    // D^-1
    Light light;
  };
  DataTerm DataAt(const Given& given, const Point& point) const;
  double Misfit(const Point& point) const;  // as MarginalValue's
  // Refers to its arguments.
  Given GivenBy(const std::array<RowMatrix, 3>& matrices,
                const DataErrors& errors,
                const LightHyperparameters& hyperparameters) const;
  // Weights of a band's log roughness [texels].
  Eigen::VectorXd BandWeights(int band) const;
  // A step of l = K representers; its quadratic model gains promise / 2.
  struct NewtonStep {
    Eigen::VectorXd representers, l;  // [3 * sources]
    double promise = 0.0;
    int iterations = 0;  // of conjugate gradients
  };
  // The log determinant's part of the gradient.
  struct DeterminantGradient {
    RowMatrix inverse;           // A^-1, rows and columns scaled as J
    double noise_share = 0.0;    // tr(A^-1 D)
    std::array<RowMatrix, 3> G;  // A^-1 J K, centred [points][sources]
    Eigen::VectorXd by_l;        // [3 * sources]
    // By log L_o, through W [3 * points]; empty: no interval.
    Eigen::VectorXd by_log_radiance;
    // diag(J^T A^-1 J K_rough) / 2 [texels].
    Eigen::VectorXd rough_share;
  };
  // A linearisation of log L_o in l, d log L_o = J dl, with what its normal
  // equations need.
  struct Linearisation {
    std::array<RowMatrix, 3> jacobian;  // [points][sources] of a channel
    std::array<RowMatrix, 3> JC;        // that of texels * correlation
    // Rows [3 * points] have 1 and D; an interval's, W^1/2 and 1.
    Eigen::VectorXd row_scale, diagonal;
    double damping = 0.0;
    // Cholesky's, of (1 + damping) diagonal + row_scale J K J^T row_scale.
    RowMatrix factor;
    Eigen::VectorXd matte_share;  // [3 * points] or empty
  };
  // exp(m + l) [3 * sources], and T L [3 * points], which it keeps above 0.
  Eigen::VectorXd Radiance(double level, const Eigen::VectorXd& l) const;
  Eigen::VectorXd Transported(const std::array<RowMatrix, 3>& matrices,
                              const Eigen::VectorXd& L) const;
  // Radiance and residuals at l.
  Point At(const Given& given, double level, const Eigen::VectorXd& l) const;
  // Null where the normal equations are not positive definite.
  // damping: see FindMode.
  std::unique_ptr<const Linearisation> Linearise(const Given& given,
                                                 const Point& point,
                                                 const DataTerm& data) const;
  // The same with J K J^T in single precision, for a preconditioner.
  std::unique_ptr<const Linearisation> LineariseRoughly(const Given& given,
                                                        const Point& point,
                                                        const DataTerm& data,
                                                        double damping) const;
  template <typename Matrix>
  std::unique_ptr<const Linearisation> LineariseIn(const Given& given,
                                                   const Point& point,
                                                   const DataTerm& data,
                                                   double damping) const;
  // K g.
  Eigen::VectorXd ApplyCovariance(const Light& light,
                                  const Eigen::VectorXd& g) const;
  // K g by the texels' covariance alone, amplitude M C.
  Eigen::VectorXd ApplyLocal(const Light& light,
                             const Eigen::VectorXd& g) const;
  // The part of that which is its step at the horizon.
  Eigen::VectorXd ApplyHorizon(const Eigen::VectorXd& g) const;
  // J K_d J^T, K_d the covariance of the directional lights, channels c and d.
  RowMatrix DirectionalLightBlock(const Linearisation& linear, int c,
                                  int d) const;
  // J K0 J^T, K0 what the amplitude does not scale: level, horizon, directional
  // lights.
  RowMatrix UnscaledBlock(const Linearisation& linear, int c, int d) const;
  Eigen::VectorXd ApplyJacobian(const Linearisation& linear,
                                const Eigen::VectorXd& l) const;
  Eigen::VectorXd ApplyJacobianTransposed(const Linearisation& linear,
                                          const Eigen::VectorXd& a) const;
  // The block of rows of channel c and columns of channel d, scaled as rows.
  static void ScaleBlock(const Linearisation& linear, int c, int d,
                         RowMatrix* block);
  // The light's part of J v and J^T a [3 * sources] at a point, without its
  // linearisation.
  Eigen::VectorXd LightJacobianTimes(const Given& given, const Point& point,
                                     const Eigen::VectorXd& v) const;
  Eigen::VectorXd LightJacobianTransposedTimes(const Given& given,
                                               const Point& point,
                                               const Eigen::VectorXd& a) const;
  // The Hessian of the first two terms times p = K representers; curvature:
  // J_l^T slope.
  Eigen::VectorXd HessianTimes(const Given& given, const Point& point,
                               const DataTerm& data,
                               const Eigen::VectorXd& curvature,
                               const Eigen::VectorXd& representers,
                               const Eigen::VectorXd& p) const;
  // matte_share K_a matte_share, channels c and d; adds it.
  void AddPaintBlock(const Eigen::VectorXd& matte_share, int c, int d,
                     RowMatrix* block) const;
  // The paint's part of l; empty: no paint.
  Eigen::VectorXd PaintOf(const Eigen::VectorXd& l) const;
  // w with K w = H^-1 x, H the Hessian of the first two terms at the point, by
  // conjugate gradients preconditioned with a linearisation near it.
  Eigen::VectorXd SolveHessian(const Given& given, const Point& point,
                               const DataTerm& data,
                               const Linearisation& linear, double tolerance,
                               const Eigen::VectorXd& x,
                               int* iterations = nullptr) const;
  // w = x - J^T A^-1 J K x: K w = (K^-1 + J^T D^-1 J)^-1 x.
  Eigen::VectorXd SolveRepresenters(const Linearisation& linear,
                                    const Light& light,
                                    const Eigen::VectorXd& x) const;
  // Where the search for the mode starts; completes `mode`.
  Point FirstPoint(const Given& given, LightMode* mode) const;
  NewtonStep FindNewtonStep(const Given& given, const Linearisation& linear,
                            const Point& point, const DataTerm& data,
                            const LightMode& mode) const;
  // Moves point, data and mode along the step; the share of it that was taken,
  // 0 where none gains. near_enough: the step promises less than the mode
  // needs. If not, a step of which rounding hides the gain is taken as well.
  double TakeStep(const Given& given, const NewtonStep& step, bool near_enough,
                  Point* point, DataTerm* data, LightMode* mode) const;
  // Completes `mode` and moves it to the mode, with point and data. False where
  // there is none, or something is not finite.
  bool FindLight(const Given& given,
                 const LightHyperparameters& hyperparameters, double tolerance,
                 const Expansion* near, Point* point, DataTerm* data,
                 LightMode* mode) const;
  // The first two terms of the cost.
  static double CostOf(const DataTerm& data, const LightMode& mode);
  // Moves `mode`, of `near`, by one step of Gauss-Newton with that one's
  // linearisation; not where it gains nothing.
  void Predict(const Given& given, const Expansion& near, Point* point,
               DataTerm* data, LightMode* mode) const;
  // Newton's method from `point`. Where steps fail, or do not end, they are
  // damped (Levenberg and Marquardt): `damping` times K^-1 joins the Hessian.
  // False: the equations are not positive definite, or not finite.
  bool FindMode(const Given& given, double tolerance, Point* point,
                DataTerm* data, LightMode* mode) const;

  // Information's blocks: marginal_posterior.cc.
  Eigen::MatrixXd InformationBy(const Light& light, const Linearisation& linear,
                                const RowMatrix& G,
                                Eigen::MatrixXd* of_hyperparameters) const;
  Eigen::MatrixXd HyperparameterInformation(const Light& light,
                                            const Linearisation& linear) const;
  // J K_b J^T, rows and columns scaled, K_b the derivative of K by the log
  // roughness of a band; rough: J of a channel times the rough part.
  RowMatrix CovarianceByBand(const Light& light, const Linearisation& linear,
                             const std::array<RowMatrix, 3>& rough,
                             int band) const;

  // The gradient's parts: marginal_gradient.cc.
  DeterminantGradient GradientOfDeterminant(const Given& given,
                                            const DataTerm& data,
                                            const Linearisation& linear) const;
  // The determinant by log L_o through W [3 * points]; empty: no interval.
  // inverse: A^-1.
  Eigen::VectorXd GradientThroughCurvature(const DataTerm& data,
                                           const RowMatrix& inverse) const;
  double NoiseShare(const Given& given, const RowMatrix& inverse) const;
  // v: H^-1 by_l; Jv: J v; Jv_light: the light's part of it. Takes G.
  void GradientByMatrices(const Point& point, const DataTerm& data,
                          const Eigen::VectorXd& v, const Eigen::VectorXd& Jv,
                          const Eigen::VectorXd& Jv_light,
                          DeterminantGradient* determinant,
                          std::array<RowMatrix, 3>* gradient) const;
  // tr(A^-1 J K1 J^T), K1 what the amplitude scales: A less D and the rest.
  double TraceByAmplitude(const Linearisation& linear,
                          const DeterminantGradient& determinant) const;
  // The derivative of K by the log roughness of a band of weights h [texels],
  // applied: that of C is diag(h) R + R diag(h), R the rough part; rough: g R
  // [3][texels].
  Eigen::VectorXd ApplyBandDerivative(const Light& light,
                                      const Eigen::VectorXd& h,
                                      const Eigen::VectorXd& g,
                                      const RowMatrix& rough) const;
  int num_points_;
  Eigen::VectorXd y_;           // [3 * points]
  Eigen::VectorXd low_, high_;  // likewise; empty: y_ is known
  Eigen::Matrix3d local_, level_, directional_light_;
  ProcessSpectrum spectrum_;
  RowMatrix roughness_weights_;  // [bands][rows]
  // The horizon's part of C at amplitude 1 is that of its step with itself.
  Eigen::VectorXd horizon_;  // [texels]
  int map_height_, map_width_, num_directional_lights_;
  double smooth_share_, rough_share_;
  double texel_variance_;       // at amplitude and roughness 1
  Eigen::MatrixXd paint_;       // K_a [3 * points]^2 or empty
  Eigen::VectorXd mean_paint_;  // a0 [3 * points] or empty
  int num_threads_;
};

struct MarginalLikelihood::Expansion {
  Expansion(const MarginalLikelihood& likelihood,
            std::array<RowMatrix, 3> matrices_of, DataErrors errors_of,
            const LightHyperparameters& hyperparameters)
      : matrices(std::move(matrices_of)),
        errors(std::move(errors_of)),
        given(likelihood.GivenBy(matrices, errors, hyperparameters)) {}
  Expansion(const Expansion&) = delete;
  Expansion& operator=(const Expansion&) = delete;

  const std::array<RowMatrix, 3> matrices;
  const DataErrors errors;
  const Given given;  // refers to those
  LightMode mode;
  Point point;
  DataTerm data;
  std::unique_ptr<const Linearisation> linear;
};

}  // namespace ibrdf
