/* gpgp lottie.hpp: C++17 wrapper of lottie.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_LOTTIE_HPP
#define GPGP_LOTTIE_HPP

#include <gpgp/lottie.h>
#include <gpgp/vector.hpp>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpLottieSource, GPGP_STRUCTURE_LOTTIE_SOURCE);
GPGP_STRUCTURE_OF(GpgpLottieInfo, GPGP_STRUCTURE_LOTTIE_INFO);
GPGP_STRUCTURE_OF(GpgpLottieFrame, GPGP_STRUCTURE_LOTTIE_FRAME);

namespace detail {
template <> struct Destroy<GpgpLottie> {
  void operator()(GpgpLottie handle) const noexcept { gpgpDestroyLottie(handle); }
};
} // namespace detail

/// A Lottie animation (gpgpCreateLottie), in libgpgp_compiler.
class Lottie : public Handle<GpgpLottie> {
public:
  using Handle::Handle;
  static Result<Lottie> create(const GpgpLottieSource& source) noexcept {
    GpgpLottie raw = nullptr;
    const GpgpResult code = gpgpCreateLottie(&source, &raw);
    return Result<Lottie>(code, Lottie(raw));
  }
  /// gpgpGetLottieInfo
  Result<GpgpLottieInfo> info() const noexcept {
    GpgpLottieInfo value = init<GpgpLottieInfo>();
    const GpgpResult code = gpgpGetLottieInfo(get(), &value);
    return Result<GpgpLottieInfo>(code, value);
  }
  /// gpgpEvaluateLottie: valid until the next call.
  Result<GpgpLottieFrame> evaluate(double frame) noexcept {
    GpgpLottieFrame value = init<GpgpLottieFrame>();
    const GpgpResult code = gpgpEvaluateLottie(get(), frame, &value);
    return Result<GpgpLottieFrame>(code, value);
  }
  /// gpgpCompileLottieFrame: a drawing as bytes for GpgpDrawingCreateInfo.
  Result<Blob> compile(double frame, const GpgpJobSystem* jobSystem = nullptr) noexcept {
    GpgpBlob blob = GpgpBlob();
    const GpgpResult code = gpgpCompileLottieFrame(get(), frame, jobSystem, &blob);
    return Result<Blob>(code, Blob(blob));
  }
};

} // namespace gpgp

#endif
