//! The names that scenes choose from and that are not names of entries or of types elsewhere.

names! {
    /// Where P and the internal variables of a law with memory stand, for the method with points.
    Histories {
        /// On the Gauss nodes, wherever the points are: no energy is made.
        Nodes = "nodes",
        /// At the points. Away from the Gauss nodes the flow of the law makes energy: for studies.
        Points = "points",
    }
}
