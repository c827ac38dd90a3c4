"""Reports and audits of folders of recordings."""
