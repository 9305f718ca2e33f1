"""What triangulations of all dimensions share: classes, measures, location, archives."""
