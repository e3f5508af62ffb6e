#include "ibrdf/uncertainty/measured_materials.h"

#include "ibrdf/uncertainty/parameter_prior.h"

namespace ibrdf {

const std::vector<MeasuredMaterial>& MeasuredMaterials() {
  // The rows of experiments/entropy/material_table.py.
  // clang-format off
  static const std::vector<MeasuredMaterial> materials = {
      {0.2913, {0.09718, 0.06908, 0.04848}},  // alum-bronze
      {0.09282, {0.008991, 0.008655, 0.00828}},  // alumina-oxide
      {0.1472, {0.1588, 0.1594, 0.1695}},  // aluminium
      {0.0926, {0.005207, 0.005208, 0.005206}},  // aventurnine
      {0.9169, {0.3945, 0.2983, 0.2607}},  // beige-fabric
      {0.9999, {0.0001263, 0.0001251, 0.000125}},  // black-fabric
      {0.1034, {0.008414, 0.007976, 0.007947}},  // black-obsidian
      {0.58, {0.02732, 0.02613, 0.02542}},  // black-oxidized-steel
      {0.1592, {0.01599, 0.01598, 0.01598}},  // black-phenolic
      {0.7318, {0.03163, 0.03096, 0.03107}},  // black-soft-plastic
      {0.1008, {0.006347, 0.00635, 0.00636}},  // blue-acrylic
      {0.8948, {0.05828, 0.06544, 0.1493}},  // blue-fabric
      {0.5439, {0.06066, 0.0534, 0.139}},  // blue-metallic-paint
      {0.1817, {0.06712, 0.09398, 0.1975}},  // blue-metallic-paint2
      {0.5581, {0.0148, 0.01579, 0.02056}},  // blue-rubber
      {0.1544, {0.128, 0.09923, 0.06302}},  // brass
      {0.4982, {0.03223, 0.02734, 0.02582}},  // cherry-235
      {0.08818, {0.1087, 0.1008, 0.1025}},  // chrome
      {0.1215, {0.1617, 0.1617, 0.1617}},  // chrome-steel
      {0.5585, {0.03719, 0.02982, 0.02793}},  // colonial-maple-223
      {0.2291, {0.03649, 0.03649, 0.03996}},  // color-changing-paint1
      {0.2736, {0.07151, 0.05981, 0.0652}},  // color-changing-paint2
      {0.2419, {0.03912, 0.03503, 0.03158}},  // color-changing-paint3
      {0.6781, {0.03218, 0.03276, 0.04073}},  // dark-blue-paint
      {0.6531, {0.03487, 0.01672, 0.01587}},  // dark-red-paint
      {0.6271, {0.02047, 0.01531, 0.01423}},  // dark-specular-fabric
      {0.4535, {0.02284, 0.02284, 0.02284}},  // delrin
      {0.4305, {0.02405, 0.0215, 0.01889}},  // fruitwood-241
      {0.53, {0.2198, 0.1503, 0.05315}},  // gold-metallic-paint
      {0.3359, {0.1743, 0.1532, 0.1293}},  // gold-metallic-paint2
      {0.2259, {0.2768, 0.1975, 0.1132}},  // gold-metallic-paint3
      {0.5433, {0.1788, 0.1261, 0.07607}},  // gold-paint
      {0.176, {0.009325, 0.009355, 0.009088}},  // gray-plastic
      {0.2103, {0.1197, 0.1188, 0.123}},  // grease-covered-steel
      {0.1065, {0.01011, 0.01012, 0.01011}},  // green-acrylic
      {0.7868, {0.03745, 0.03916, 0.04657}},  // green-fabric
      {0.8597, {0.1261, 0.1723, 0.08328}},  // green-latex
      {0.4846, {0.03025, 0.09677, 0.1078}},  // green-metallic-paint
      {0.1973, {0.03392, 0.07888, 0.04766}},  // green-metallic-paint2
      {0.08566, {0.005256, 0.005265, 0.005266}},  // green-plastic
      {0.1595, {0.05338, 0.05271, 0.05599}},  // hematite
      {0.516, {0.03235, 0.02725, 0.02546}},  // ipswich-pine-221
      {0.8905, {0.0582, 0.02362, 0.01662}},  // light-brown-fabric
      {0.6289, {0.04729, 0.02569, 0.02475}},  // light-red-paint
      {0.09199, {0.006608, 0.006588, 0.006587}},  // maroon-plastic
      {0.498, {0.03427, 0.02901, 0.02695}},  // natural-209
      {0.5739, {0.06666, 0.05888, 0.05006}},  // neoprene-rubber
      {0.2282, {0.2048, 0.1817, 0.16}},  // nickel
      {0.3859, {0.01758, 0.01754, 0.01711}},  // nylon
      {0.6546, {0.06076, 0.03006, 0.0228}},  // orange-paint
      {0.5821, {0.2101, 0.1815, 0.1401}},  // pearl-paint
      {0.6569, {0.1151, 0.1072, 0.1031}},  // pickled-oak-260
      {0.8751, {0.3318, 0.2972, 0.2975}},  // pink-fabric
      {0.8316, {0.3862, 0.1728, 0.1569}},  // pink-fabric2
      {0.7798, {0.1839, 0.1449, 0.132}},  // pink-felt
      {0.1459, {0.01633, 0.009323, 0.00924}},  // pink-jasper
      {0.6811, {0.03514, 0.01713, 0.01554}},  // pink-plastic
      {0.7458, {0.1366, 0.1395, 0.136}},  // polyethylene
      {0.9309, {0.2182, 0.09585, 0.0739}},  // polyurethane-foam
      {0.6101, {0.04031, 0.03524, 0.0256}},  // pure-rubber
      {0.3314, {0.04708, 0.01721, 0.01875}},  // purple-paint
      {0.261, {0.01266, 0.01266, 0.01266}},  // pvc
      {0.8457, {0.2624, 0.0477, 0.0288}},  // red-fabric
      {0.9065, {0.3749, 0.04909, 0.02358}},  // red-fabric2
      {0.1805, {0.2363, 0.03703, 0.01975}},  // red-metallic-paint
      {0.1518, {0.01481, 0.01387, 0.01387}},  // red-phenolic
      {0.6205, {0.06242, 0.03951, 0.03614}},  // red-plastic
      {0.1007, {0.008032, 0.006385, 0.006383}},  // red-specular-plastic
      {0.1141, {0.0222, 0.02147, 0.02207}},  // silicon-nitrade
      {0.4969, {0.2323, 0.2297, 0.2264}},  // silver-metallic-paint
      {0.6209, {0.4078, 0.3845, 0.354}},  // silver-metallic-paint2
      {0.5302, {0.1988, 0.1988, 0.1988}},  // silver-paint
      {0.5738, {0.02762, 0.02292, 0.02128}},  // special-walnut-224
      {0.09405, {0.01019, 0.01073, 0.01127}},  // specular-black-phenolic
      {0.0894, {0.008143, 0.008144, 0.008146}},  // specular-blue-phenolic
      {0.08802, {0.007766, 0.007768, 0.007768}},  // specular-green-phenolic
      {0.0855, {0.0075, 0.007484, 0.007482}},  // specular-maroon-phenolic
      {0.0684, {0.002538, 0.002502, 0.002495}},  // specular-orange-phenolic
      {0.09125, {0.004616, 0.003945, 0.003942}},  // specular-red-phenolic
      {0.0826, {0.006441, 0.006126, 0.006144}},  // specular-violet-phenolic
      {0.06766, {0.008272, 0.008188, 0.008041}},  // specular-white-phenolic
      {0.08686, {0.008062, 0.006753, 0.006738}},  // specular-yellow-phenolic
      {0.1096, {0.1176, 0.1175, 0.1175}},  // ss440
      {0.1006, {0.1188, 0.1188, 0.1188}},  // steel
      {0.5267, {0.04193, 0.04536, 0.04645}},  // teflon
      {0.08715, {0.08737, 0.07892, 0.07966}},  // tungsten-carbide
      {0.3552, {0.2013, 0.1762, 0.1507}},  // two-layer-gold
      {0.3529, {0.1951, 0.1913, 0.1902}},  // two-layer-silver
      {0.1338, {0.01708, 0.01707, 0.02403}},  // violet-acrylic
      {0.6446, {0.07203, 0.04914, 0.05706}},  // violet-rubber
      {0.1044, {0.003464, 0.003462, 0.003458}},  // white-acrylic
      {0.4923, {0.06399, 0.06152, 0.04368}},  // white-diffuse-bball
      {0.8736, {0.2632, 0.1987, 0.1481}},  // white-fabric
      {0.9594, {0.2168, 0.2094, 0.2297}},  // white-fabric2
      {0.1212, {0.01024, 0.01021, 0.01015}},  // white-marble
      {0.1915, {0.01801, 0.01895, 0.01484}},  // white-paint
      {0.1698, {0.002527, 0.002257, 0.002103}},  // yellow-matte-plastic
      {0.6395, {0.04557, 0.03244, 0.01962}},  // yellow-paint
      {0.142, {0.02422, 0.0195, 0.01254}},  // yellow-phenolic
      {0.6191, {0.03185, 0.02984, 0.02009}},  // yellow-plastic
  };
  // clang-format on
  return materials;
}

std::vector<double> PriorOfMeasuredMaterials(
    const std::vector<double>& alpha_values,
    const std::vector<double>& Ks_values) {
  std::vector<double> alpha, Ks;
  for (const MeasuredMaterial& m : MeasuredMaterials()) {
    for (const double k : m.Ks) {
      alpha.push_back(m.roughness * m.roughness);
      Ks.push_back(k);
    }
  }
  return PriorOfMaterials(alpha, Ks, alpha_values, Ks_values, 1.0);
}

}  // namespace ibrdf
