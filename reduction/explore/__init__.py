"""The explorer: a page on this machine that moves the settings of a test and saves them."""
