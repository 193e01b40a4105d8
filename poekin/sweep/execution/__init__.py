"""Running a sweep: in parts, by threads or an executor, with a store of what is done."""
