//! Messages to the host.

use std::ffi::CStr;

/// Result of a call, numbered as in the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with something to be read in the log.
    Warning = 1,
    /// Not done, or not to its end; the simulation may go on from where it is.
    Discard = 2,
    /// Refused.
    Error = 3,
    /// The instance cannot be used any more.
    Fatal = 4,
}

/// The topic of a message. Hosts switch categories on and off by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// Messages about events.
    Events,
    /// Doubts about the results.
    Warning,
    /// Steps that end early, questions without an answer.
    Discard,
    /// Refused calls.
    Error,
}

impl Category {
    /// All of them.
    pub const ALL: [Category; 4] = [Category::Events, Category::Warning, Category::Discard, Category::Error];

    /// Name, as the standard recommends it, and the topic in one line.
    const fn words(self) -> (&'static CStr, &'static str) {
        match self {
            Category::Events => (c"logEvents", "events, as they happen"),
            Category::Warning => (c"logStatusWarning", "warnings about the results; always on in FMI 2.0"),
            Category::Discard => (c"logStatusDiscard", "steps that end early and the reasons; always on"),
            Category::Error => (c"logStatusError", "rejected calls and the reasons; always on"),
        }
    }

    /// Name.
    pub const fn name(self) -> &'static CStr {
        self.words().0
    }

    /// The one called `name`, if there is one.
    pub fn named(name: &str) -> Option<Category> {
        Category::ALL.into_iter().find(|category| category.name().to_str() == Ok(name))
    }

    /// The topic in one line.
    pub const fn description(self) -> &'static str {
        self.words().1
    }
}

/// Takes the status, the category's name and the message; none if nobody listens.
pub type Sink = Option<Box<dyn Fn(Status, &CStr, &str)>>;

/// Sends messages. The reasons of discards and errors are always sent, events and warnings while their category is on.
pub struct Logger {
    sink: Sink,
    /// Whether the categories of events and of warnings are on.
    pub(crate) on: [bool; 2],
}

impl Logger {
    /// A logger into `sink`, with warnings and without events.
    pub fn new(sink: Sink) -> Logger {
        Logger { on: [false, sink.is_some()], sink }
    }

    /// Switches `categories` on or off; discards and errors stay on.
    pub fn switch(&mut self, categories: &[Category], on: bool) {
        for category in categories {
            self.on.get_mut(*category as usize).into_iter().for_each(|is_on| *is_on = on && self.sink.is_some());
        }
    }

    /// Sends an event, which is put into words only if someone listens.
    pub fn event(&self, message: impl FnOnce() -> String) {
        if self.on[Category::Events as usize] {
            self.send(Status::Ok, Category::Events, &message());
        }
    }

    /// Sends a warning, which is put into words only if someone listens. The call that it comes from returns OK: the
    /// standard lets a simulation go on after `fmi2Warning`, but OMSimulator (2940ef1) ends it there, after
    /// `fmi2ExitInitializationMode` as after `fmi2DoStep`.
    pub fn warning(&self, message: impl FnOnce() -> String) {
        if self.on[Category::Warning as usize] {
            self.send(Status::Warning, Category::Warning, &message());
        }
    }

    /// Sends why a call returns `status`.
    pub fn failure(&self, status: Status, message: &str) {
        let category = if status == Status::Discard { Category::Discard } else { Category::Error };
        self.send(status, category, message);
    }

    fn send(&self, status: Status, category: Category, message: &str) {
        self.sink.iter().for_each(|sink| sink(status, category.name(), message));
    }
}
