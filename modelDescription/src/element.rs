//! Elements of XML.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;

pub(crate) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Vec<Element>,
}

impl Element {
    pub fn new(name: &'static str) -> Element {
        Element { name, attributes: Vec::new(), content: Vec::new() }
    }

    pub fn with(self, name: &'static str, value: impl ToString) -> Element {
        self.with_any(name, Some(value))
    }

    /// The element with one more attribute, if that has a value.
    pub fn with_any(mut self, name: &'static str, value: Option<impl ToString>) -> Element {
        self.attributes.extend(value.map(|value| (name, value.to_string())));
        self
    }

    /// The element with more attributes, all of them true.
    pub fn with_true(self, names: &[&'static str]) -> Element {
        names.iter().fold(self, |element, name| element.with(name, true))
    }

    pub fn holding(mut self, elements: impl IntoIterator<Item = Element>) -> Element {
        self.content.extend(elements);
        self
    }

    pub fn unless_empty(self) -> Option<Element> {
        (!self.content.is_empty()).then_some(self)
    }

    /// The document whose root is the element, with an indent of two spaces.
    pub fn document(&self) -> String {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        let written = writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)));
        written.and_then(|()| self.write(&mut writer)).expect("memory can be written to");
        String::from_utf8(writer.into_inner()).expect("names and values are text") + "\n"
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
        let attributes = self.attributes.iter().map(|(name, value)| (*name, value.as_str()));
        let element = writer.create_element(self.name).with_attributes(attributes);
        if self.content.is_empty() {
            element.write_empty()?;
        } else {
            element.write_inner_content(|writer| self.content.iter().try_for_each(|inner| inner.write(writer)))?;
        }
        Ok(())
    }
}

/// The fewest digits that read back the same: `1e-9`, not `0.000000001`.
pub(crate) fn digits(number: f64) -> String {
    format!("{number:?}")
}
