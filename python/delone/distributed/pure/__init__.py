"""What tiles are, what is certain about them and how answers change them: no files, no tasks."""
