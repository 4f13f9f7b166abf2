#include "bdh_any_stokes.h"
#include "device_backend.h"
#include "typed_confined.h"

// The same random numbers, number for number, and the same forces on the walls.  On rows longer than the strips of the host,
// of odd and even length.
TEST(DeviceSlit, SolvesAsTheHost)
{
  for (const Grid &small : walled_grids())
    for (const long more : {7L, 30L})
      for (const bool noisy : {false, true}) {
        Grid g = solver_order(small)(small);
        for (int d = 0; d < g.dim; ++d) g.n[d] += d == 0 ? more : 3;
        StokesProblem p = quiet(1.3);
        p.body_force = {0.1, 0.2, -0.3};
        p.kT_over_dt = noisy ? 0.7 : 0.0;
        p.seed = 11;
        p.step = 5;
        p.stress.push_back({1.0, 0});
        p.stress.push_back({0.5, 1});
        Backend::Stokes device(g, self(), FftEffort::estimate);
        AnyStokes host(g, self(), FftEffort::estimate);
        Backend::Vector on_device[3];
        AlignedVector on_host[3];
        FieldView there{}, here{};
        for (int d = 0; d < g.dim; ++d) {
          std::vector<double> f = random_numbers(device.allocation(), 20 + d);
          if (d == g.slow_axis()) std::fill_n(f.begin(), f.size() / static_cast<std::size_t>(g.n[d]), 0.0);    // the wall
          Access<Backend>::put(f, on_device[d]);
          on_host[d].resize(host.allocation());
          std::copy(f.begin(), f.end(), on_host[d].begin());
          there[d] = on_device[d].data();
          here[d] = on_host[d].data();
        }
        const WallVectors found = device.solve(there, p).wall_force, expected = host.solve(here, p).wall_force;
        for (int d = 0; d < g.dim; ++d) {
          const std::vector<double> v = Access<Backend>::get(on_device[d]);
          double most = 0.0, off = 0.0;
          for_slab(g, {0, g.n[g.slow_axis()]}, [&](std::size_t local, std::size_t) {
            most = std::max(most, std::fabs(on_host[d][local]));
            off = std::max(off, std::fabs(v[local] - on_host[d][local]));
          });
          EXPECT_GT(most, 0.0) << wall_names(g);
          EXPECT_LT(off, 1e-13 * most) << wall_names(g) << " component " << d << (noisy ? " with noise" : "");
        }
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side)
            for (int d = 0; d < 3; ++d)
              EXPECT_NEAR(found[axis][side][d], expected[axis][side][d], 1e-12 * g.length[0] * g.length[1] * g.length[2]) << wall_names(g);
      }
}
