use crate::Error;
use crate::contents::Contents;
use crate::source::Source;

pub(crate) fn read(source: &mut Source) -> Result<Contents, Error> {
    Err(source.at_byte("this format is not yet read"))
}
