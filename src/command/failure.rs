//! Why a command ends with an exit code other than 0.

use crosscap_backends::files::FileError;
use crosscap_core::Error;
use std::fmt;

/// Why a command ends with an exit code other than 0.
#[derive(Debug)]
pub enum Failure {
    /// Bad usage, bad input, or a file that cannot be written.
    Usage(String),
    /// No verified mesh.
    NotVerified(String),
}

impl Failure {
    /// Exit code of [`Failure::Usage`].
    pub const USAGE: u8 = 2;

    /// Bad usage or bad input.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => Self::USAGE,
            Self::NotVerified(_) => 1,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(message) | Self::NotVerified(message) => f.write_str(message),
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Usage(error.to_string())
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        if error.is_input() {
            Self::Usage(error.to_string())
        } else {
            Self::NotVerified(error.to_string())
        }
    }
}
