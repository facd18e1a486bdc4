// Whether this is compiled under the address or the thread sanitizer: its shadow memory alone is over any limit of
// memory, it checks a `new` of its own, and a run takes ten to a hundred times as long.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RAYWALK_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RAYWALK_SANITIZED 1
#endif
#endif
#if !defined(RAYWALK_SANITIZED)
#define RAYWALK_SANITIZED 0
#endif
