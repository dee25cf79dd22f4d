//! Ground motion records: PEER AT2 and CSV.
