// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The registers of a calibration in memory, beside those of sptfra_registers: 0x080 to 0x0A8 of the map in the design's
// control/NAME.rdl, with a curve in the banks 0x0AC.
//
// Reads answer in the same cycle. Words are written whole: fewer strobes than four change nothing but CALIBRATION_INDEX
// and CALIBRATION_ERRORS.

`default_nettype none

module sptfra_calibration_registers #(
    // The words before CALIBRATION_INDEX, the first in the lowest bits: CALIBRATION, its limit of offsets, its steps
    parameter [4*32-1:0] CONSTANTS = {4{32'd0}},
    // The register of the curve; 0: there is none
    parameter [31:0] CURVE = 32'd0
) (
    input  wire clock,
    input  wire reset,
    // Accesses
    input  wire write_enable,
    input  wire [9:0] write_word,
    input  wire [31:0] write_data,
    input  wire [31:0] write_mask,
    output wire write_mapped,
    input  wire [9:0] read_word,
    output reg  [31:0] read_data, // zero elsewhere
    output wire read_mapped,
    // Commands
    input  wire idle,
    input  wire taring,
    output reg  [15:0] index,
    output reg  index_active,
    output wire write,
    input  wire write_allowed,
    input  wire [31:0] word,
    output wire commit,
    output wire tare,
    // State and errors
    input  wire active,
    input  wire [7:0] version,
    input  wire [31:0] crc,
    input  wire wrong_crc,
    input  wire not_at_rest,
    input  wire bad_frame,
    input  wire tare_out_of_range,
    input  wire contradiction
);

    // Addresses, in words
    localparam [9:0] CALIBRATION = 10'd32;
    localparam [9:0] CALIBRATION_INDEX = 10'd36;
    localparam [9:0] CALIBRATION_DATA = 10'd37;
    localparam [9:0] CALIBRATION_COMMIT = 10'd38;
    localparam [9:0] TARE = 10'd39;
    localparam [9:0] CALIBRATION_STATUS = 10'd40;
    localparam [9:0] CALIBRATION_ERRORS = 10'd41;
    localparam [9:0] CALIBRATION_CRC = 10'd42;
    localparam [9:0] CALIBRATION_CURVE = 10'd43;
    localparam [9:0] LAST = (CURVE != 32'd0) ? CALIBRATION_CURVE : CALIBRATION_CRC;
    localparam [31:0] MOST_LOG2 = 32'd10; // of tare's frames

    reg [5:0] errors; // contradiction, bad frame, not at rest, wrong CRC, busy, out of range

    function is_mapped(input [9:0] at);
        is_mapped = (at >= CALIBRATION) && (at <= LAST);
    endfunction

    assign write_mapped = is_mapped(write_word);
    assign read_mapped = is_mapped(read_word);

    // ---- Reads
    wire is_constant = (read_word >= CALIBRATION) && (read_word < CALIBRATION_INDEX);

    always @(*) begin
        case (read_word)
            CALIBRATION_INDEX: read_data = {index_active, 15'd0, index};
            CALIBRATION_DATA: read_data = idle ? word : 32'd0;
            CALIBRATION_STATUS: read_data = {21'd0, taring, !idle, active, version};
            CALIBRATION_ERRORS: read_data = {26'd0, errors};
            CALIBRATION_CRC: read_data = crc;
            CALIBRATION_CURVE: read_data = CURVE;
            // Commands read as zero
            default: read_data = is_constant ? CONSTANTS[{read_word[1:0], 5'd0} +: 32] : 32'd0;
        endcase
    end

    // ---- Writes
    wire whole = write_enable && (write_mask == 32'hffffffff);
    wire to_data = whole && (write_word == CALIBRATION_DATA);
    wire to_commit = whole && (write_word == CALIBRATION_COMMIT);
    wire to_tare = whole && (write_word == TARE);
    wire tare_fits = (write_data <= MOST_LOG2);
    wire [31:0] index_next = ({index_active, 15'd0, index} & ~write_mask) | (write_data & write_mask);
    wire [5:0] ones = write_data[5:0] & write_mask[5:0];
    wire [5:0] cleared = (write_enable && (write_word == CALIBRATION_ERRORS)) ? ones : 6'd0;
    wire [5:0] events = {
        contradiction,
        bad_frame,
        not_at_rest,
        wrong_crc,
        (to_data || to_commit || to_tare) && !idle,
        tare_out_of_range || (idle && ((to_data && !write_allowed) || (to_tare && !tare_fits)))
    };

    assign write = to_data;
    assign commit = to_commit && idle;
    assign tare = to_tare && idle && tare_fits;

    always @(posedge clock) begin
        if (write_enable && (write_word == CALIBRATION_INDEX)) begin
            index <= index_next[15:0];
            index_active <= index_next[31];
        end else if (to_data && idle) begin
            index <= index + 16'd1;
        end
        // An event in the cycle in which its bit is cleared is not lost
        errors <= (errors & ~cleared) | events;
        if (reset) begin
            index <= 16'd0;
            index_active <= 1'b0;
            errors <= 6'd0;
        end
    end

    wire _unused = &{1'b0, index_next[30:16]};

endmodule

`default_nettype wire
