#!/usr/bin/env bash
# tests/wide_instructions.sh LIBRARY: that functions which all processors run hold no instruction that only some have. Each
# kernel is compiled between Highway's BEFORE and AFTER, in a namespace of its instruction set (N_SSE4, N_AVX2, N_AVX3);
# what else a source makes, a copy of std::max for one, may be the copy that the linker keeps for the whole program.
set -euo pipefail
objdump --disassemble --no-show-raw-insn --no-addresses "$1" | awk '
    /^<.*>:$/ { name = $1; own = name ~ /N_(SSE4|AVX2|AVX3)/; functions += 1; kernels += own; next }
    # (tzcnt is bsf to older processors, which is what the compiler means where it writes it)
    !own && /^\t/ && $1 ~ /^(v[a-z]|popcnt|lzcnt|andn$|bextr|bzhi|bls[irmk]|pdep|pext|round[sp][sd]|blendv|p(blendv|blendw|insr[bdq]|extr[bdq]|mulld|shufb|ackusdw|min(sb|sd|uw|ud)|max(sb|sd|uw|ud)|movsx|movzx|test))/ {
        print "an instruction that not every processor has: " $0 " in " name; found += 1
    }
    END {
        print functions + 0 " functions, " kernels + 0 " of them of one instruction set, " found + 0 " wrong instructions"
        exit !(functions > 50 && kernels > 10 && found == 0)
    }'
