//! How the allocator of glibc gives memory back.

/// Pieces from this size on are mapped by themselves, bytes.
#[cfg(target_env = "gnu")]
const LARGE: libc::c_int = 1 << 20;

/// Makes the allocator give large pieces back to the system when they are freed. By itself it stops to do so for sizes up to that of the
/// largest piece that was ever freed: a rank that has made the whole state once then keeps up to one more of them, or not, by chance. A step
/// allocates nothing, so it is no slower.
///
/// Where the environment says `MALLOC_MMAP_THRESHOLD_`, that holds.
#[cfg(target_env = "gnu")]
#[allow(unsafe_code)]
pub fn give_large_pieces_back() {
    if std::env::var_os("MALLOC_MMAP_THRESHOLD_").is_none() {
        // SAFETY: mallopt changes a number of the allocator; nothing else runs yet.
        unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, LARGE) };
    }
}

/// Other allocators are left as they are.
#[cfg(not(target_env = "gnu"))]
pub fn give_large_pieces_back() {}
