// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Control of the grid search: three stages, each with a frame of its own.
//
// The search takes a frame one cycle after its u_q, its sums and CeAn's results are there. The features take the
// search's result, the correction that of the features. A stage holds its result until the next one takes it, and may
// begin anew in the cycle after. The features begin anew only after the correction has their window. Without features
// the correction comes after the search.

`default_nettype none

module sptfra_joint_stages #(
    // 1: features for a network; 0: none
    parameter integer FEATURES = 1
) (
    input  wire clock,
    input  wire reset,
    // What a frame needs: the last of its u_q, one cycle, to be in the memories in the next; sums and contact, held
    // until the search starts
    input  wire u_complete,
    input  wire sums_complete,
    input  wire contact_valid,
    // Ends, one cycle each: of the search, of the features, of the window that they show, of the correction
    input  wire search_done,
    input  wire features_done,
    input  wire window_done,
    input  wire correction_done,
    input  wire answer_take, // only with answer_valid
    // Starts, one cycle each
    output reg  search_start, // a register: it lets all of the frame's 800 bits in, and others out
    output wire features_start,
    output wire correction_start,
    output wire answer_valid,
    // One cycle: the search needs the u_q of its frame no more
    output wire u_released,
    // Of u_q: that which is to come into the memory, that which is searched
    output reg  fill_bank,
    output reg  search_bank
);

    if ((FEATURES != 0) && (FEATURES != 1)) begin : gen_check
        sptfra_error_there_are_features_or_none invalid ();
    end

    reg [1:0] u_waiting; // frames whose u_q wait to be searched
    reg searching;
    reg centroid_waits; // for the features
    reg extracting; // until the correction takes what was found
    reg showing; // the window, to the correction
    reg centre_waits; // for the correction
    reg correcting;
    reg answer_waits; // to be taken
    wire centroid_there = search_done || centroid_waits;

    wire search_free = searching ? features_start : !search_start; // in the next cycle
    wire u_there = u_complete || (u_waiting != 2'd0);

    assign features_start = centroid_there && ((FEATURES != 0) ? !extracting && !showing : !correcting);
    assign correction_start = (FEATURES != 0) ? (features_done || centre_waits) && !correcting : features_start;
    assign answer_valid = correction_done || answer_waits;
    assign u_released = features_start;

    always @(posedge clock) begin
        search_start <= sums_complete && contact_valid && u_there && search_free;
        u_waiting <= u_waiting + {1'b0, u_complete} - {1'b0, search_start};
        if (u_complete) begin
            fill_bank <= !fill_bank;
        end
        if (search_start) begin
            searching <= 1'b1;
        end
        if (search_done) begin
            centroid_waits <= 1'b1;
        end
        if (features_start) begin
            searching <= 1'b0;
            centroid_waits <= 1'b0;
            search_bank <= !search_bank;
            extracting <= (FEATURES != 0);
        end
        if (features_done) begin
            centre_waits <= 1'b1;
        end
        if (window_done) begin
            showing <= 1'b0;
        end
        if (correction_start) begin
            extracting <= 1'b0;
            showing <= (FEATURES != 0);
            centre_waits <= 1'b0;
            correcting <= 1'b1;
        end
        if (correction_done) begin
            answer_waits <= 1'b1;
        end
        if (answer_take) begin
            correcting <= 1'b0;
            answer_waits <= 1'b0;
        end
        if (reset) begin
            search_start <= 1'b0;
            u_waiting <= 2'd0;
            fill_bank <= 1'b0;
            search_bank <= 1'b0;
            searching <= 1'b0;
            centroid_waits <= 1'b0;
            extracting <= 1'b0;
            showing <= 1'b0;
            centre_waits <= 1'b0;
            correcting <= 1'b0;
            answer_waits <= 1'b0;
        end
    end

endmodule

`default_nettype wire
