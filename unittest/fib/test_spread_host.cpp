// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/host.h"
#define TEST_BACKEND bdh::FibOnHost
#include "fib/typed_spread.h"

#include <numeric>

// Rows of fields larger than the caches are read ahead where there are enough particles.
TEST(SpreadOnHost, ReadingAheadChangesNothing)
{
  const Grid g = make_grid({96, 80, 100}, {1.0});
  const long n = 4500, alone = 50;
  const std::size_t size = 2 * g.half() * g.n[1] * g.n[2];
  const std::vector<double> x = random_positions(g, n, 1), force = random_numbers(3 * n, 2);
  std::vector<double> flow = random_numbers(3 * size, 3), spread(3 * size, 0.0), u(3 * n),
                      some(3 * alone);
  const auto view = [size](std::vector<double> &f) {
    return FieldView{f.data(), f.data() + size, f.data() + 2 * size};
  };
  HostSpreader<double> all(g, whole(g), IbKernel::peskin4), few(g, whole(g), IbKernel::peskin4);
  all.bind(x.data(), n);
  few.bind(x.data(), alone);
  all.interpolate(view(flow), u.data());
  few.interpolate(view(flow), some.data());
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_DOUBLE_EQ(u[i], some[i]) << i;
  all.spread(force.data(), 0.0, view(spread));
  const auto dot = [](const std::vector<double> &a, const std::vector<double> &b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  EXPECT_NEAR(dot(force, u), dot(spread, flow), 1e-12 * norm(force) * norm(u));
}
