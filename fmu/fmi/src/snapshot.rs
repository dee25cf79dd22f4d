//! FMU states: kept for the host under handles, and as bytes.
//!
//! Bytes are the name of the build, a state as postcard writes it, and the checksum of both (16 bytes): a UUID v5.

use crate::failure::Failure;
use crate::interface::Interface;
use crate::model::Experiment;
use crate::state_machine::Stage;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::hash::BuildHasher;
use uuid::Uuid;

/// All that the future of an instance depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The side that integrates.
    pub interface: Interface,
    /// Stage of the instance.
    pub stage: Stage,
    /// The times and the tolerance that the host gave.
    pub experiment: Experiment,
    /// The model's own part.
    pub model: Vec<u8>,
}

/// The FMU states that one instance has handed out and not freed.
///
/// A handle is a number that no state had before, not an address: one that was freed, or is another instance's, is not
/// found, whatever the memory allocator does.
#[derive(Debug, Default)]
pub(crate) struct Snapshots {
    live: HashMap<usize, Snapshot>,
    handed_out: u64,
}

impl Snapshots {
    /// Keeps `snapshot` under `handle`, which must be a live one; 0 asks for a new one. Returns the handle.
    pub fn keep(&mut self, handle: usize, snapshot: Snapshot) -> Result<usize, Failure> {
        let handle = if handle == 0 { self.new_handle() } else { self.find(handle).map(|_| handle)? };
        self.live.insert(handle, snapshot);
        Ok(handle)
    }

    /// The state kept under `handle`.
    pub fn find(&self, handle: usize) -> Result<&Snapshot, Failure> {
        self.live.get(&handle).ok_or(Failure::UnknownSnapshot(handle))
    }

    /// The model's part of the state kept under `handle`, which has none until it is kept anew: its memory is used again.
    pub fn take_bytes(&mut self, handle: usize) -> Result<Vec<u8>, Failure> {
        let kept = self.live.get_mut(&handle).ok_or(Failure::UnknownSnapshot(handle))?;
        Ok(std::mem::take(&mut kept.model))
    }

    /// Forgets the state kept under `handle`.
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

impl Snapshot {
    /// The state as bytes of the `build`.
    pub fn serialize(&self, build: &str) -> Vec<u8> {
        let payload = postcard::to_stdvec(self).expect("numbers and bytes can always be written");
        let mut bytes = [build.as_bytes(), &payload].concat();
        bytes.extend(checksum(&bytes));
        bytes
    }

    /// The state that `bytes` of the `build` hold, or what is wrong with them.
    pub fn deserialize(build: &str, bytes: &[u8]) -> Result<Snapshot, Failure> {
        let Some(rest) = bytes.strip_prefix(build.as_bytes()) else {
            return Err(Failure::BadBytes("it does not begin with the name of this build"));
        };
        let whole = rest.split_last_chunk().filter(|(_, sum)| checksum(&bytes[..bytes.len() - sum.len()]) == **sum);
        let Some((payload, _)) = whole else { return Err(Failure::BadBytes("its checksum is wrong")) };
        read_state(payload)
    }
}

/// Writes `state` at the end of `bytes`, for [`Model::state`](crate::Model::state).
pub fn write_state(state: &impl Serialize, bytes: &mut Vec<u8>) {
    let written = postcard::to_extend(state, std::mem::take(bytes));
    *bytes = written.expect("numbers, text and lists can always be written");
}

/// The state of which [`write_state`] wrote these `bytes`.
pub fn read_state<S: for<'a> Deserialize<'a>>(bytes: &[u8]) -> Result<S, Failure> {
    let read = postcard::take_from_bytes(bytes).ok().filter(|(_, rest)| rest.is_empty());
    read.map(|(state, _)| state).ok_or(Failure::BadBytes("its content cannot be read"))
}

fn checksum(bytes: &[u8]) -> [u8; 16] {
    Uuid::new_v5(&Uuid::NAMESPACE_OID, bytes).into_bytes()
}
