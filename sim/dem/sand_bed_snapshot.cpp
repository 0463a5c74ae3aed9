// A bed as bytes, exact: rows in their order, so that sums go on in the same order.
#include <stdexcept>

#include "sim/dem/sand_bed_impl.h"

namespace hoof::sim {

template <typename Real>
void SandBed::ImplOf<Real>::save(ByteWriter& out) const {
  out.put(std::uint32_t(sizeof(Real)));
  out.put(count);
  out.put(settings.dt_s);
  out.put(health);
  out.put(interval_time_s);
  out.put(lost);
  out.put_all(now);
  list.save(out);
  boundary.save(out);
}

template <typename Real>
void SandBed::ImplOf<Real>::restore(ByteReader& in) {
  if (in.get<std::uint32_t>() != sizeof(Real) || in.get<std::uint32_t>() != count ||
      in.get<double>() != settings.dt_s) {
    throw std::runtime_error("is of another bed: precision, number of grains or step differ");
  }
  in.get(health);
  in.get(interval_time_s);
  in.get(lost);
  in.get_all(now);
  if (now.size() != next.size()) throw std::runtime_error("is of another number of grains");
  next = now;
  list.load(in, now, count, domain, team);
  share_out();
  boundary.load<Real>(in);
  if (!in.at_end()) throw std::runtime_error("is longer than it should be");
}

#define HOOF_INSTANTIATE(Real)                                  \
  template void SandBed::ImplOf<Real>::save(ByteWriter&) const; \
  template void SandBed::ImplOf<Real>::restore(ByteReader&);
HOOF_INSTANTIATE(float)
HOOF_INSTANTIATE(double)
#undef HOOF_INSTANTIATE

}  // namespace hoof::sim
