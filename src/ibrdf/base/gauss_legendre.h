// Gauss and Legendre's quadrature.
#pragma once
#include <vector>

namespace ibrdf {

// Nodes and weights on [0, 1], n >= 1: exact for polynomials up to degree
// 2 n - 1.
void GaussLegendre(int n, std::vector<double>* nodes,
                   std::vector<double>* weights);

}  // namespace ibrdf
