//! The hot path is compiled for the processor's features: no intrinsic of AVX2 or AVX-512 stands in the program as a function of
//! its own. One that does was called from code without the features (a generic function without `#[inline(always)]`, or
//! a closure), which is 4 to 6 times slower, silently: see `core/src/lane.rs`.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use object::{Object, ObjectSymbol, SymbolKind};

/// Whether a function is an intrinsic that should have become one instruction.
fn is_lost_intrinsic(name: &str) -> bool {
    name.starts_with("core::core_arch::") && (name.contains("::_mm256_") || name.contains("::_mm512_"))
}

/// Demangled names of the functions of a program.
fn functions(program: &[u8]) -> Vec<String> {
    let file = object::File::parse(program).unwrap();
    let functions = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.is_definition());
    functions.filter_map(|symbol| Some(format!("{:#}", rustc_demangle::demangle(symbol.name().ok()?)))).collect()
}

#[test]
fn no_intrinsic_stands_alone_in_the_program() {
    if cfg!(debug_assertions) {
        return; // Nothing but `inline(always)` is inlined without optimisation.
    }
    let names = functions(&std::fs::read(env!("CARGO_BIN_EXE_dgmpm")).unwrap());
    // The symbol table is there, and the entry to the kernels is in it.
    assert!(names.len() > 1000, "only {} functions", names.len());
    for entry in ["enter_avx2", "enter_avx512"] {
        assert!(names.iter().any(|name| name.contains(entry)), "no `{entry}`");
    }
    let lost: Vec<&String> = names.iter().filter(|name| is_lost_intrinsic(name)).collect();
    assert!(
        lost.is_empty(),
        "called without the processor's features: {lost:#?}\nfind the caller by `perf` or `objdump -d`, and mark \
         every generic function and closure on the way to it `#[inline(always)]` (closures: write a loop)"
    );
}

#[test]
fn the_search_would_find_one() {
    let found = |symbol: &str| is_lost_intrinsic(&format!("{:#}", rustc_demangle::demangle(symbol)));
    // As they stood in this program when a closure was on the path, in both manglings.
    assert!(found("_ZN4core9core_arch3x863avx13_mm256_mul_pd17h0123456789abcdefE"));
    assert!(found("_RNvNtNtNtCs1234_4core9core_arch3x863avx13__mm256_add_pd"));
    assert!(!found("_ZN5dgmpm4lane3x8610enter_avx217h0123456789abcdefE"));
    assert!(!found("_ZN4core9core_arch3x864sse211_mm_mfence17h0123456789abcdefE"));
}
