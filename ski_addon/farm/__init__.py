"""Runs on render farms: job bundles for Open Job Description, and jobs for Flamenco."""
