//! cocone
