//! FMU states: kept for the host under handles, and as bytes.
//!
//! Bytes are the name of the build (38), a condition as postcard writes it, and the checksum of both (16): a UUID v5.

use crate::BUILD;
use crate::condition::Condition;
use crate::failure::Failure;
use std::collections::HashMap;
use std::hash::BuildHasher;
use uuid::Uuid;

/// The FMU states that one instance has handed out and not freed.
///
/// A handle is a number that no state had before, not an address: one that was freed, or is another instance's, is not
/// found, whatever the memory allocator does.
#[derive(Debug, Default)]
pub struct Snapshots {
    live: HashMap<usize, Condition>,
    handed_out: u64,
}

impl Snapshots {
    /// Keeps `condition` under `handle`, which must be a live one; 0 asks for a new one. Returns the handle.
    pub fn keep(&mut self, handle: usize, condition: Condition) -> Result<usize, Failure> {
        let handle = if handle == 0 { self.new_handle() } else { self.find(handle).map(|_| handle)? };
        self.live.insert(handle, condition);
        Ok(handle)
    }

    /// The condition kept under `handle`.
    pub fn find(&self, handle: usize) -> Result<&Condition, Failure> {
        self.live.get(&handle).ok_or(Failure::UnknownSnapshot(handle))
    }

    /// Forgets the condition kept under `handle`.
    pub fn free(&mut self, handle: usize) -> Result<(), Failure> {
        self.live.remove(&handle).map(drop).ok_or(Failure::UnknownSnapshot(handle))
    }

    /// The map's own hash keys are random and differ between instances, so that handles do, too.
    fn new_handle(&mut self) -> usize {
        loop {
            self.handed_out += 1;
            let handle = self.live.hasher().hash_one(self.handed_out) as usize;
            if handle != 0 && !self.live.contains_key(&handle) {
                return handle;
            }
        }
    }
}

/// A condition as bytes.
pub fn serialize(condition: &Condition) -> Vec<u8> {
    let payload = postcard::to_stdvec(condition).expect("numbers and enumerations can always be written");
    let mut bytes = [BUILD.as_bytes(), &payload].concat();
    bytes.extend(checksum(&bytes));
    bytes
}

/// The condition that `bytes` hold, or what is wrong with them.
pub fn deserialize(bytes: &[u8]) -> Result<Condition, Failure> {
    let Some(rest) = bytes.strip_prefix(BUILD.as_bytes()) else {
        return Err(Failure::BadBytes("it does not begin with the name of this build"));
    };
    let whole = rest.split_last_chunk().filter(|(_, given)| checksum(&bytes[..bytes.len() - given.len()]) == **given);
    let Some((payload, _)) = whole else { return Err(Failure::BadBytes("its checksum is wrong")) };
    postcard::from_bytes(payload).map_err(|_| Failure::BadBytes("its content cannot be read"))
}

fn checksum(bytes: &[u8]) -> [u8; 16] {
    Uuid::new_v5(&Uuid::NAMESPACE_OID, bytes).into_bytes()
}
