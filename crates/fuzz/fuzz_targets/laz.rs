#![no_main]

// The decoder of someone else panics on some damaged files; the reader catches that. The hook that the fuzzer
// sets would end the process before it can.
libfuzzer_sys::fuzz_target!(
    init: std::panic::set_hook(Box::new(|_| {})),
    |bytes: &[u8]| pellicle_fuzz::read(pellicle_fuzz::Format::Laz, bytes)
);
