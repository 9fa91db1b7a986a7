//! Rows of the whole cloud.

use serde::{Deserialize, Serialize};

crosscap_core::id! {
    /// A row of the whole cloud. In a tile a [`Row`](crosscap_core::Row) is a row of the tile alone.
    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct CloudRow(u32);
}
