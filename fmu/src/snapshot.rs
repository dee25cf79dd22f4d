//! FMU states: kept for the host under handles, and as bytes.
//!
//! ```text
//! "FlexRock"   8 bytes
//! version      4 bytes, little endian
//! build        38 bytes
//! length       4 bytes, little endian: of the payload
//! payload      a condition, by postcard
//! checksum     16 bytes: UUID v5 of everything before
//! ```

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

const MAGIC: [u8; 8] = *b"FlexRock";
const VERSION: u32 = 7;

/// A condition as bytes.
pub fn serialize(condition: &Condition) -> Vec<u8> {
    let payload = postcard::to_stdvec(condition).expect("numbers and enumerations can always be written");
    let length = u32::try_from(payload.len()).expect("the payload is a few hundred bytes and a name");
    let mut bytes = header().to_vec();
    bytes.extend(length.to_le_bytes());
    bytes.extend(payload);
    bytes.extend(checksum(&bytes));
    bytes
}

/// The condition that `bytes` hold, or which part of them is wrong.
pub fn deserialize(bytes: &[u8]) -> Result<Condition, Failure> {
    let header = header();
    let Some((given_header, rest)) = bytes.split_at_checked(header.len()) else {
        return Err(Failure::BadBytes("it is too short"));
    };
    if given_header[..MAGIC.len()] != MAGIC {
        return Err(Failure::BadBytes("it does not begin as one"));
    }
    if given_header[MAGIC.len()..][..4] != VERSION.to_le_bytes() {
        return Err(Failure::BadBytes("it has another format version"));
    }
    if given_header != header {
        return Err(Failure::BadBytes("it was written by another build of the FMU"));
    }
    let parts = rest.split_first_chunk().and_then(|(length, rest)| Some((length, rest.split_last_chunk()?)));
    let Some((length, (payload, given_checksum))) = parts else {
        return Err(Failure::BadBytes("it is too short"));
    };
    if payload.len() != u32::from_le_bytes(*length) as usize {
        return Err(Failure::BadBytes("its length is not the one that it states"));
    }
    if checksum(&bytes[..bytes.len() - given_checksum.len()]) != *given_checksum {
        return Err(Failure::BadBytes("its checksum is wrong"));
    }
    let condition: Condition =
        postcard::from_bytes(payload).map_err(|_| Failure::BadBytes("its content cannot be read"))?;
    if !condition.is_possible() {
        return Err(Failure::BadBytes("its content contradicts itself"));
    }
    Ok(condition)
}

fn checksum(bytes: &[u8]) -> [u8; 16] {
    Uuid::new_v5(&Uuid::NAMESPACE_OID, bytes).into_bytes()
}

/// Everything before the length.
fn header() -> [u8; 50] {
    let mut header = [0; 50];
    header[..8].copy_from_slice(&MAGIC);
    header[8..12].copy_from_slice(&VERSION.to_le_bytes());
    header[12..].copy_from_slice(BUILD.as_bytes());
    header
}
